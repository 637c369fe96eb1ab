/*
 * arkit.c - what moves a face. Values are weights, 1000 for 1. Written by labial rig 0.3.0; do not edit.
 */
#include "arkit.h"

/* weights, invert, contact, gain, neutral, minimum, maximum, slew, closed, deadband, acceleration, curve */
static const labial_rig_output_t outputs[10] = {
    /* jawOpen: 0.394581 per FAP unit of (+0.643 open_jaw -1 raise_b_midlip_o) */
    { { 2634, 0, 0, 0, -4096, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 25859, -21, 0, 1000, 0, 0, 0, 0, 0 },
    /* mouthClose: 0.839842 per FAP unit of (+0.331 open_jaw +1 lower_t_midlip_o +0.238 raise_b_midlip_o) */
    { { 5423, 0, 0, 16384, 3899, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 13760, 0, 0, 1000, 0, 0, 0, 0, 0 },
    /* mouthPucker: 3.98565 per FAP unit of (+0.084 push_b_lip -0.5 stretch_l_cornerlip_o -0.5
     * stretch_r_cornerlip_o) */
    { { 0, 43, 0, 0, 0, -256, -256, 0, 0, 0, 0, 0, 0 },
      0, 0, 2089629, 0, 0, 1000, 0, 0, 0, 0, 0 },
    /* mouthSmileLeft: 3.02904 per FAP unit of (+0.033 open_jaw +1 stretch_l_cornerlip_o -0.026
     * raise_l_cornerlip_o) */
    { { 541, 0, 0, 0, 0, 16384, 0, 0, 0, 0, 0, -426, 0 },
      0, 0, 49628, -1, 0, 1000, 0, 0, 0, 0, 0 },
    /* mouthSmileRight: 3.02904 per FAP unit of (+0.033 open_jaw +1 stretch_r_cornerlip_o -0.026
     * raise_r_cornerlip_o) */
    { { 541, 0, 0, 0, 0, 0, 16384, 0, 0, 0, 0, 0, -426 },
      0, 0, 49628, -1, 0, 1000, 0, 0, 0, 0, 0 },
    /* mouthStretchLeft: 4.31744 per FAP unit of (+1 stretch_l_cornerlip_o -0.076 raise_l_cornerlip_o) */
    { { 0, 0, 0, 0, 0, 16384, 0, 0, 0, 0, 0, -1245, 0 },
      0, 0, 70737, -5, 0, 1000, 0, 0, 0, 0, 0 },
    /* mouthStretchRight: 4.31744 per FAP unit of (+1 stretch_r_cornerlip_o -0.076 raise_r_cornerlip_o) */
    { { 0, 0, 0, 0, 0, 0, 16384, 0, 0, 0, 0, 0, -1245 },
      0, 0, 70737, -5, 0, 1000, 0, 0, 0, 0, 0 },
    /* mouthUpperUpLeft: 3.00184 per FAP unit of (-1 lower_t_midlip_o -0.112 raise_b_midlip_o) */
    { { 0, 0, 0, -16384, -1835, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 49182, -140, 0, 1000, 0, 0, 0, 0, 0 },
    /* mouthUpperUpRight: 3.00184 per FAP unit of (-1 lower_t_midlip_o -0.112 raise_b_midlip_o) */
    { { 0, 0, 0, -16384, -1835, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 49182, -140, 0, 1000, 0, 0, 0, 0, 0 },
    /* mouthRollLower: 4.19886 per FAP unit of (+1 open_jaw -1 lower_t_midlip_o +1 raise_b_midlip_o) */
    { { 4096, 0, 0, -4096, 4096, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 275176, -250, 0, 400, 0, 0, 0, 0, 0 }
};

const labial_rig_t arkit = { outputs, 10 };
