// The surface on which P5 moves: both joints through a whole turn, and where a ray meets it.

const CELLS = 96; // of each joint's turn

/** The surface of an arm as a grid that closes up: places, normals and joint angles of its vertices. */
function workspaceOf(arm) {
  const side = CELLS + 1, step = TURN / CELLS, [first, second] = arm.limits;
  const positions = new Float32Array(3 * side * side), normals = new Float32Array(3 * side * side);
  const angles = new Float32Array(2 * side * side), triangles = new Uint32Array(6 * CELLS * CELLS);
  const base = rigid(arm.joint1), joint2 = rigid(arm.joint2);
  for (let i = 0; i < side; i++) {
    const turned = times(times(base, turnZ(first[0] + i * step)), joint2);
    const pole = moved(base, [0, 0, 0]), axis = minus(moved(base, [0, 0, 1]), pole);
    for (let j = 0; j < side; j++) {
      const at = i * side + j, theta2 = second[0] + j * step;
      const pose = times(turned, turnX(theta2)), place = moved(pose, arm.p5);
      // Along both turns: P5 goes across each axis and its lever.
      const centre = moved(pose, [0, 0, 0]), axis2 = minus(moved(pose, [1, 0, 0]), centre);
      const normal = unit(cross(cross(axis, minus(place, pole)), cross(axis2, minus(place, centre))));
      positions.set(place, 3 * at);
      normals.set(normal, 3 * at);
      angles.set([first[0] + i * step, theta2], 2 * at);
    }
  }
  for (let i = 0, k = 0; i < CELLS; i++)
    for (let j = 0; j < CELLS; j++, k += 6) {
      const a = i * side + j, b = a + side;
      triangles.set([a, b, b + 1, a, b + 1, a + 1], k);
    }
  return { positions, normals, angles, triangles };
}

/** Where a ray first meets the surface: the joint angles there, or null. */
function jointsHit({ positions: p, angles, triangles }, origin, direction) {
  let nearest = Infinity, found = null;
  const [ox, oy, oz] = origin, [dx, dy, dz] = direction;
  for (let k = 0; k < triangles.length; k += 3) {
    const a = 3 * triangles[k], b = 3 * triangles[k + 1], c = 3 * triangles[k + 2];
    const ux = p[b] - p[a], uy = p[b + 1] - p[a + 1], uz = p[b + 2] - p[a + 2];
    const vx = p[c] - p[a], vy = p[c + 1] - p[a + 1], vz = p[c + 2] - p[a + 2];
    const qx = dy * vz - dz * vy, qy = dz * vx - dx * vz, qz = dx * vy - dy * vx;
    const det = ux * qx + uy * qy + uz * qz;
    if (Math.abs(det) < 1e-14) continue;
    const sx = ox - p[a], sy = oy - p[a + 1], sz = oz - p[a + 2];
    const s = (sx * qx + sy * qy + sz * qz) / det;
    if (s < 0 || s > 1) continue;
    const rx = sy * uz - sz * uy, ry = sz * ux - sx * uz, rz = sx * uy - sy * ux;
    const t = (dx * rx + dy * ry + dz * rz) / det;
    if (t < 0 || s + t > 1) continue;
    const far = (vx * rx + vy * ry + vz * rz) / det;
    if (far <= 0 || far >= nearest) continue;
    nearest = far;
    const angle = (n) => (1 - s - t) * angles[2 * triangles[k] + n] + s * angles[2 * triangles[k + 1] + n] + t * angles[2 * triangles[k + 2] + n];
    found = { joints: [angle(0), angle(1)], far };
  }
  return found;
}

/** Whether joint angles are within the limits, and P5 there above the floor. */
function isReachable(arm, joints, floor) {
  const [first, second] = arm.limits;
  const inside = joints[0] <= first[1] + 1e-9 && joints[1] <= second[1] + 1e-9;
  return inside && (floor === null || tipOf(arm, joints)[2] >= floor - 1e-9);
}
