/*
 * jaw.c - what moves a face. Values are microseconds. Written by labial rig 0.4.0; do not edit.
 */
#include "jaw.h"

/* weights, invert, contact, gain, neutral, minimum, maximum, slew, closed, deadband, acceleration, curve, visemes */
static const labial_rig_output_t outputs[1] = {
    /* jaw: 0.833333 per FAP unit of (-1 lower_t_midlip_o -1 raise_b_midlip_o), 1400 where lips touch */
    { { 0, 0, 0, -4096, -4096, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 1, 54613, 1400, 1400, 1900, 0, 1400, 0, 0, 0, 0 }
};

const labial_rig_t jaw = { outputs, 1 };
