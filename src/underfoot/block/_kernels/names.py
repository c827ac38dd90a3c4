"""Places of the numbers in the arrays ``state`` and ``control`` of a march."""

from __future__ import annotations

# state: changed every step; the sums NORMAL to COUNT are cleared with every sample
TIME, SLID, TOP, TOP_SPEED = 0, 1, 2, 3
FLOOR_WORK, TOP_WORK, DAMPING_LOSS, CONTACT_LOSS = 4, 5, 6, 7
NORMAL, SHEAR, LATERAL, AREA, ABSOLUTE, RESULTANT, COUNT = 8, 9, 10, 11, 12, 13, 14
LAST_SHEAR, LAST_STEP, KINETIC, CONTACT_ENERGY = 15, 16, 17, 18
STRAIN, HOURGLASS, LOSS_RATE, HOURGLASS_LOSS, LEAST_J = 19, 20, 21, 22, 23
SAMPLE_TOP_WORK, SAMPLE_FLOOR_WORK = 24, 25
STATE_SIZE = 26

# control: fixed for a call
DT, ALPHA, FREE, LOAD, LOAD_TIME, PLATE_MASS, PLATE_DAMPING = 0, 1, 2, 3, 4, 5, 6
SPEED, SLIDE_START, RAMP, ZETA = 7, 8, 9, 10
COLUMNS, ROWS, LAYERS, PERIODIC, G0, BULK = 11, 12, 13, 14, 15, 16
CONTROL_SIZE = 17
