/*
 * jaw.c - what moves a face. Values are microseconds. Written by labial rig 0.3.0; do not edit.
 */
#include "jaw.h"

/* weights, invert, reserved, gain, neutral, minimum, maximum, slew */
static const labial_rig_output_t outputs[1] = {
    /* jaw: 0.833333 per FAP unit of (-1 lower_t_midlip_o -1 raise_b_midlip_o) */
    { { 0, 0, 0, -4096, -4096, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 54613, 1400, 1400, 1900, 0 }
};

const labial_rig_t jaw = { outputs, 1 };
