// Meshes that everything is drawn with: positions and normals, three numbers a vertex, and triangles.

const emptyMesh = () => ({ positions: [], normals: [], triangles: [] });

function joined(meshes) {
  const all = emptyMesh();
  for (const mesh of meshes) {
    const first = all.positions.length / 3;
    for (const value of mesh.positions) all.positions.push(value);
    for (const value of mesh.normals) all.normals.push(value);
    for (const index of mesh.triangles) all.triangles.push(first + index);
  }
  return all;
}

/** The triangles of a grid of rings, each closed. */
function addRings(mesh, rings, sides) {
  for (let ring = 0; ring + 1 < rings; ring++)
    for (let side = 0; side < sides; side++) {
      const a = ring * sides + side, b = ring * sides + ((side + 1) % sides);
      mesh.triangles.push(a, b, b + sides, a, b + sides, a + sides);
    }
}

/** A round tube along points, its ends rounded; of one point it is a ball. */
function tubeMesh(points, radius, sides = 20, round = 5) {
  const mesh = emptyMesh(), count = points.length;
  const along = points.map((_, i) =>
    unit(count > 1 ? minus(points[Math.min(i + 1, count - 1)], points[Math.max(i - 1, 0)]) : [0, 0, 1]));
  let across = unit(cross(along[0], Math.abs(along[0][2]) < 0.9 ? [0, 0, 1] : [1, 0, 0]));
  let rings = 0;
  const addRing = (point, t, a, lean) => {
    const b = cross(t, a);
    for (let side = 0; side < sides; side++) {
      const angle = (2 * Math.PI * side) / sides;
      const radial = plus(scaled(a, Math.cos(angle)), scaled(b, Math.sin(angle)));
      const normal = plus(scaled(radial, Math.cos(lean)), scaled(t, Math.sin(lean)));
      mesh.positions.push(...plus(point, scaled(normal, radius)));
      mesh.normals.push(...normal);
    }
    rings += 1;
  };
  for (let k = 0; k < round; k++) addRing(points[0], along[0], across, (Math.PI / 2) * (k / round - 1));
  points.forEach((point, i) => {
    const t = along[i];
    across = unit(minus(across, scaled(t, dot(across, t))));
    addRing(point, t, across, 0);
  });
  for (let k = 1; k <= round; k++) addRing(points[count - 1], along[count - 1], across, (Math.PI / 2) * (k / round));
  addRings(mesh, rings, sides);
  return mesh;
}

const ballMesh = (centre, radius, sides = 20) => tubeMesh([centre], radius, sides, Math.ceil(sides / 4));

/** A box: `axes` has its own axes as the columns. */
function boxMesh(centre, size, axes) {
  const mesh = emptyMesh();
  const axis = (k) => [axes[0][k], axes[1][k], axes[2][k]];
  for (let k = 0; k < 3; k++)
    for (const sign of [-1, 1]) {
      const normal = scaled(axis(k), sign), first = mesh.positions.length / 3;
      const middle = plus(centre, scaled(normal, size[k] / 2));
      const u = scaled(axis((k + 1) % 3), (sign * size[(k + 1) % 3]) / 2), v = scaled(axis((k + 2) % 3), size[(k + 2) % 3] / 2);
      for (const [p, q] of [[-1, -1], [1, -1], [1, 1], [-1, 1]]) {
        mesh.positions.push(...plus(middle, plus(scaled(u, p), scaled(v, q))));
        mesh.normals.push(...normal);
      }
      mesh.triangles.push(first, first + 1, first + 2, first, first + 2, first + 3);
    }
  return mesh;
}

/** A cone along z, its base at a place. */
function coneMesh(base, radius, height, sides = 20) {
  const mesh = emptyMesh(), slant = Math.hypot(radius, height);
  for (let side = 0; side < sides; side++) {
    const a = (2 * Math.PI * side) / sides, c = Math.cos(a), s = Math.sin(a);
    mesh.positions.push(base[0] + radius * c, base[1] + radius * s, base[2], base[0], base[1], base[2] + height);
    mesh.normals.push(...[0, 1].flatMap(() => [(c * height) / slant, (s * height) / slant, radius / slant]));
    const k = 2 * side, next = (2 * (side + 1)) % (2 * sides);
    mesh.triangles.push(k, next, k + 1);
  }
  return mesh;
}

/** Three crossed bars: the mark of what is missed. */
function jackMesh(centre, size) {
  const arms = [[1, 1, 0], [1, -1, 0], [0, 0, 1.4142]].map((d) => scaled(unit(d), size));
  return joined(arms.map((d) => tubeMesh([minus(centre, d), plus(centre, d)], size / 4, 8, 2)));
}

/** A line of dashes from one point to another. */
function dashesMesh(start, end, radius, dash) {
  const count = Math.max(1, Math.round(norm(minus(end, start)) / dash));
  const piece = (k) => [mixed(start, end, (k + 0.15) / count), mixed(start, end, (k + 0.75) / count)];
  return joined(Array.from({ length: count }, (_, k) => tubeMesh(piece(k), radius, 8, 2)));
}
