/*
 * arkit.c - what moves a face. Values are weights, 1000 for 1. Written by labial rig 0.4.0; do not edit.
 */
#include "arkit.h"

/* weights, invert, contact, gain, neutral, minimum, maximum, slew, closed, deadband, acceleration, curve */
static const labial_rig_output_t outputs[10] = {
    /* jawOpen: 0.525222 per FAP unit of (+0.222 open_jaw -1 lower_t_midlip_o -0.872 raise_b_midlip_o) */
    { { 3637, 0, 0, -16384, -14287, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 8605, -34, 0, 1000, 0, 0, 0, 0, 0 },
    /* mouthClose: 0.36762 per FAP unit of (+0.251 open_jaw +1 lower_t_midlip_o +0.305 raise_b_midlip_o) */
    { { 1028, 0, 0, 4096, 1249, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 24092, 0, 0, 1000, 0, 0, 0, 0, 0 },
    /* mouthPucker: 4.66636 per FAP unit of (+0.038 push_b_lip +0.128 push_t_lip -0.5 stretch_l_cornerlip_o
     * -0.5 stretch_r_cornerlip_o) */
    { { 0, 1245, 4194, 0, 0, -16384, -16384, 0, 0, 0, 0, 0, 0 },
      0, 0, 38227, 0, 0, 1000, 0, 0, 0, 0, 0 },
    /* mouthSmileLeft: 3.75657 per FAP unit of (+0.035 open_jaw +1 stretch_l_cornerlip_o -0.04
     * raise_l_cornerlip_o) */
    { { 573, 0, 0, 0, 0, 16384, 0, 0, 0, 0, 0, -655, 0 },
      0, 0, 61548, 0, 0, 1000, 0, 0, 0, 0, 0 },
    /* mouthSmileRight: 3.75657 per FAP unit of (+0.035 open_jaw +1 stretch_r_cornerlip_o -0.04
     * raise_r_cornerlip_o) */
    { { 573, 0, 0, 0, 0, 0, 16384, 0, 0, 0, 0, 0, -655 },
      0, 0, 61548, 0, 0, 1000, 0, 0, 0, 0, 0 },
    /* mouthStretchLeft: 4.52127 per FAP unit of (+1 stretch_l_cornerlip_o -0.083 raise_l_cornerlip_o) */
    { { 0, 0, 0, 0, 0, 4096, 0, 0, 0, 0, 0, -340, 0 },
      0, 0, 296306, -10, 0, 1000, 0, 0, 0, 0, 0 },
    /* mouthStretchRight: 4.52127 per FAP unit of (+1 stretch_r_cornerlip_o -0.083 raise_r_cornerlip_o) */
    { { 0, 0, 0, 0, 0, 0, 4096, 0, 0, 0, 0, 0, -340 },
      0, 0, 296306, -10, 0, 1000, 0, 0, 0, 0, 0 },
    /* mouthUpperUpLeft: 1.62251 per FAP unit of (-1 lower_t_midlip_o -0.15 raise_b_midlip_o) */
    { { 0, 0, 0, -16384, -2458, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 26583, -77, 0, 1000, 0, 0, 0, 0, 0 },
    /* mouthUpperUpRight: 1.62251 per FAP unit of (-1 lower_t_midlip_o -0.15 raise_b_midlip_o) */
    { { 0, 0, 0, -16384, -2458, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 26583, -77, 0, 1000, 0, 0, 0, 0, 0 },
    /* mouthRollLower: 5.87965 per FAP unit of (+0.714 open_jaw -1 lower_t_midlip_o +0.714 raise_b_midlip_o) */
    { { 5849, 0, 0, -8192, 5849, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 192664, -280, 0, 400, 0, 0, 0, 0, 0 }
};

const labial_rig_t arkit = { outputs, 10 };
