"""The columns of a row of unknowns: what a shape is in numbers, and where the base stands if that is free."""

ARCS = 4  # equal arcs of a link: eight curvatures and a length for the five numbers of an end pose
CURVATURES = slice(0, 2 * ARCS)  # (kx, ky) of each arc in units of the largest one
LENGTH = 2 * ARCS  # of the link, m
D35, D45 = LENGTH + 1, LENGTH + 2  # m; there where the rigid link is free
BASE = slice(-6, None)  # x, y, z, roll, pitch, yaw, m and rad; there where the base is free
BASE_NUMBERS = 6
