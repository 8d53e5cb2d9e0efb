// The arm: two turns about axes, between the rigid transforms that come with each shape.

/** Where the two links are: transforms of what joint 1 carries, and of what joint 2 carries. */
function poses(arm, joints) {
  const first = times(rigid(arm.joint1), turnZ(joints[0]));
  return { base: rigid(arm.joint1), first, second: times(times(first, rigid(arm.joint2)), turnX(joints[1])) };
}

const tipOf = (arm, joints) => moved(poses(arm, joints).second, arm.p5);

/** The marked points, by name. */
function pointsOf(arm, joints) {
  const { base, second } = poses(arm, joints);
  return {
    P1: moved(base, arm.axis1[0]),
    P2: moved(base, arm.axis1[1]),
    P3: moved(second, arm.axis2[0]),
    P4: moved(second, arm.axis2[1]),
    P5: moved(second, arm.p5),
  };
}

const TURN = 2 * Math.PI;

/** An angle within limits, or the nearer of them; whole turns do not count. */
function within([lowest, highest], angle) {
  const middle = (lowest + highest) / 2;
  const near = angle - TURN * Math.round((angle - middle) / TURN);
  return Math.min(Math.max(near, lowest), highest);
}

/** The meshes of an arm: of its base, of the link that joint 1 carries, of what joint 2 carries. */
function armMeshes(arm) {
  const { tube_radius: tube, rod_radius: rod, axis1, axis2 } = arm;
  const thin = Math.max(rod, 0.28 * tube, 0.004), thick = Math.max(tube, 0.006), axle = Math.max(0.3 * thick, 0.004);
  const beyond = 0.13, up = unit(minus(axis2[1], axis2[0]));
  return {
    base: tubeMesh(axis1, thick * 1.12, 28),
    link: tubeMesh(arm.centreline, thick, 28),
    rod: joined([tubeMesh([arm.link_end, arm.p5], thin, 20), tubeMesh(axis2, axle, 16)]),
    axis1: dashesMesh(plus(axis1[0], [0, 0, -0.05]), plus(axis1[1], [0, 0, 0.22]), 0.0016, 0.03),
    axis2: dashesMesh(minus(axis2[0], scaled(up, beyond)), plus(axis2[1], scaled(up, beyond)), 0.0016, 0.03),
  };
}
