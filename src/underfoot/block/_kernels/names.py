"""Places of the numbers in the arrays ``state`` and ``control`` of a march."""

# state: changed every step; the sums NORMAL to COUNT are cleared with every sample
TIME, SLID, TOP, TOP_SPEED, FLOOR_WORK, TOP_WORK, DAMPING_LOSS, CONTACT_LOSS = range(8)
NORMAL, SHEAR, LATERAL, AREA, ABSOLUTE, RESULTANT, COUNT = range(8, 15)
LAST_SHEAR, LAST_STEP, KINETIC, CONTACT_ENERGY, STRAIN, HOURGLASS = range(15, 21)
LOSS_RATE, HOURGLASS_LOSS, LEAST_J, SAMPLE_TOP_WORK, SAMPLE_FLOOR_WORK, STATE_SIZE = range(21, 27)

# control: fixed for a call
DT, ALPHA, FREE, LOAD, LOAD_TIME, PLATE_MASS, PLATE_DAMPING, SPEED, SLIDE_START = range(9)
RAMP, ZETA, COLUMNS, ROWS, LAYERS, PERIODIC, G0, BULK, CONTROL_SIZE = range(9, 18)
