/*
 * sprites.c - what moves a face. Values are plain units. Written by labial rig 0.4.0; do not edit.
 */
#include "sprites.h"

/* weights, invert, contact, gain, neutral, minimum, maximum, slew, closed, deadband, acceleration, curve, visemes */
static const labial_rig_output_t outputs[4] = {
    /* opening: 1 per FAP unit of (-1 lower_t_midlip_o -1 raise_b_midlip_o) */
    { { 0, 0, 0, -4096, -4096, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 65536, 0, 0, 700, 0, 0, 0, 0, 0, 0 },
    /* smile: 2.5 per FAP unit of (+0.2 open_jaw +0.25 stretch_l_cornerlip_o +0.25 stretch_r_cornerlip_o
     * +0.25 raise_l_cornerlip_o +0.25 raise_r_cornerlip_o) */
    { { 3277, 0, 0, 0, 0, 4096, 4096, 0, 0, 0, 0, 4096, 4096 },
      0, 0, 40960, 0, -300, 400, 0, 0, 0, 0, 0, 0 },
    /* rounding: 2 per FAP unit of (+1 push_t_lip -0.5 stretch_l_cornerlip_o -0.5 stretch_r_cornerlip_o) */
    { { 0, 0, 4096, 0, 0, -2048, -2048, 0, 0, 0, 0, 0, 0 },
      0, 0, 131072, 0, -100, 500, 0, 0, 0, 0, 0, 0 },
    /* upper: 1.66667 per FAP unit of (-1 lower_t_midlip_o) */
    { { 0, 0, 0, -4096, 0, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 109227, 0, -200, 200, 0, 0, 0, 0, 0, 0 }
};

const labial_rig_t sprites = { outputs, 4 };
