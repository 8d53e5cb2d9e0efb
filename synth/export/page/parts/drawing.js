// Drawing with WebGL 2: three programs, for what is solid, for the workspace, and for the floor.

const VERTEX = `#version 300 es
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 angles;
uniform mat4 projection, pose;
out vec3 place, across;
out vec2 turned;
void main() {
  vec4 at = pose * vec4(position, 1.0);
  place = at.xyz;
  across = mat3(pose) * normal;
  turned = angles;
  gl_Position = projection * at;
}`;

const SOLID = `#version 300 es
precision highp float;
in vec3 place, across;
uniform vec3 eye, key;
uniform vec4 colour;
uniform float flatness;
out vec4 shown;
void main() {
  vec3 n = normalize(across), view = normalize(eye - place);
  float light = 0.50 + 0.16 * n.z + 0.42 * max(dot(n, key), 0.0);
  float shine = 0.16 * pow(max(dot(reflect(-key, n), view), 0.0), 28.0);
  shown = vec4(mix(colour.rgb * light + shine, colour.rgb, flatness), colour.a);
}`;

// Glass: clearer where one looks at it straight on. A line every 30 degrees of either joint, and along the limits.
const SURFACE = `#version 300 es
precision highp float;
in vec3 place, across;
in vec2 turned;
uniform vec3 eye;
uniform vec4 limits, colour;
uniform float floorHeight, beyond;
out vec4 shown;
void main() {
  vec2 lowest = limits.xz, highest = limits.yw;
  bool reachable = all(lessThanEqual(turned, highest)) && place.z >= floorHeight;
  float rim = pow(1.0 - abs(dot(normalize(across), normalize(eye - place))), 2.0);
  vec2 width = fwidth(turned), step30 = turned / radians(30.0);
  vec2 grid = abs(fract(step30 - 0.5) - 0.5) / fwidth(step30);
  float line = 1.0 - clamp(min(grid.x, grid.y), 0.0, 1.0);
  vec2 limited = step(highest - lowest, vec2(6.28));
  vec2 off = min(abs(turned - highest), abs(turned - lowest)) / width + 1e3 * (1.0 - limited);
  float edge = 1.0 - clamp(min(off.x, off.y) - 0.6, 0.0, 1.0);
  float alpha = reachable ? 0.15 + 0.42 * rim + 0.16 * line + 0.5 * edge : beyond * (0.07 + 0.22 * rim + 0.10 * line);
  vec3 tint = reachable ? colour.rgb : vec3(0.55);
  shown = vec4(tint, alpha * colour.a);
}`;

const FLOOR = `#version 300 es
precision highp float;
in vec3 place;
uniform vec4 colour;
uniform vec3 middle;
uniform float extent;
out vec4 shown;
void main() {
  vec2 cells = place.xy / 0.1, grid = abs(fract(cells - 0.5) - 0.5) / fwidth(cells);
  float line = 1.0 - clamp(min(grid.x, grid.y), 0.0, 1.0);
  float fade = 1.0 - smoothstep(0.35, 1.0, length(place.xy - middle.xy) / extent);
  shown = vec4(colour.rgb, colour.a * fade * (0.10 + 0.55 * line));
}`;

function makeProgram(gl, fragment) {
  const program = gl.createProgram();
  for (const [kind, source] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  const places = {};
  for (let k = 0; k < gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); k++) {
    const { name } = gl.getActiveUniform(program, k);
    places[name] = gl.getUniformLocation(program, name);
  }
  return { program, places };
}

/** What draws on a canvas, or null where there is no WebGL 2. */
function makeDrawing(canvas) {
  const gl = canvas.getContext("webgl2", { antialias: true, alpha: false, stencil: true, preserveDrawingBuffer: true });
  if (!gl) return null;
  const programs = { solid: makeProgram(gl, SOLID), surface: makeProgram(gl, SURFACE), floor: makeProgram(gl, FLOOR) };
  gl.enable(gl.BLEND);
  gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE_MINUS_SRC_ALPHA);

  /** Put a mesh where the graphics card has it. */
  function stored(mesh) {
    const array = gl.createVertexArray(), buffers = [];
    gl.bindVertexArray(array);
    [mesh.positions, mesh.normals, mesh.angles].forEach((values, place) => {
      if (!values) return;
      buffers.push(gl.createBuffer());
      gl.bindBuffer(gl.ARRAY_BUFFER, buffers.at(-1));
      gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(values), gl.STATIC_DRAW);
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, place === 2 ? 2 : 3, gl.FLOAT, false, 0, 0);
    });
    buffers.push(gl.createBuffer());
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffers.at(-1));
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, new Uint32Array(mesh.triangles), gl.STATIC_DRAW);
    return { array, buffers, count: mesh.triangles.length };
  }

  function removed({ array, buffers }) {
    gl.deleteVertexArray(array);
    buffers.forEach((buffer) => gl.deleteBuffer(buffer));
  }

  /** Draw a stored mesh with one of the programs and its uniforms. */
  function draw(kind, mesh, uniforms) {
    const { program, places } = programs[kind];
    gl.useProgram(program);
    for (const [name, value] of Object.entries(uniforms)) {
      if (!(name in places)) continue;
      if (typeof value === "number") gl.uniform1f(places[name], value);
      else if (value.length === 16) gl.uniformMatrix4fv(places[name], false, value);
      else if (value.length === 4) gl.uniform4fv(places[name], value);
      else gl.uniform3fv(places[name], value);
    }
    gl.bindVertexArray(mesh.array);
    gl.drawElements(gl.TRIANGLES, mesh.count, gl.UNSIGNED_INT, 0);
  }
  return { gl, stored, removed, draw };
}
