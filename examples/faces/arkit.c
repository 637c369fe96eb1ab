/*
 * arkit.c - what moves a face. Values are thousandths of a weight. Written by labial rig 0.3.0; do not edit.
 */
#include "arkit.h"

/* weights, invert, reserved, gain, neutral, minimum, maximum, slew */
static const labial_rig_output_t outputs[20] = {
    /* jawOpen: 1.25 per FAP unit of (+1 open_jaw) */
    { { 4096, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 81920, 0, 0, 1000, 0 },
    /* mouthClose: 1.25 per FAP unit of (+1 open_jaw +1.4 lower_t_midlip_o +1 raise_b_midlip_o) */
    { { 8192, 0, 0, 11469, 8192, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 40960, 0, 0, 1000, 0 },
    /* mouthFunnel: 4.24242 per FAP unit of (+1 push_t_lip -0.2 lower_t_midlip_o -0.2 raise_b_midlip_o -0.5
     * stretch_l_cornerlip_o -0.5 stretch_r_cornerlip_o) */
    { { 0, 0, 16384, -3277, -3277, -8192, -8192, 0, 0, 0, 0, 0, 0 },
      0, 0, 69508, -400, 0, 1000, 0 },
    /* mouthPucker: 3.92857 per FAP unit of (+1 push_t_lip +0.1 lower_t_midlip_o +0.1 raise_b_midlip_o -0.5
     * stretch_l_cornerlip_o -0.5 stretch_r_cornerlip_o) */
    { { 0, 0, 8192, 819, 819, -4096, -4096, 0, 0, 0, 0, 0, 0 },
      0, 0, 128731, -100, 0, 1000, 0 },
    /* mouthStretchLeft: 4 per FAP unit of (+1 stretch_l_cornerlip_o -0.5 raise_l_cornerlip_o) */
    { { 0, 0, 0, 0, 0, 4096, 0, 0, 0, 0, 0, -2048, 0 },
      0, 0, 262144, 0, 0, 1000, 0 },
    /* mouthStretchRight: 4 per FAP unit of (+1 stretch_r_cornerlip_o -0.5 raise_r_cornerlip_o) */
    { { 0, 0, 0, 0, 0, 0, 4096, 0, 0, 0, 0, 0, -2048 },
      0, 0, 262144, 0, 0, 1000, 0 },
    /* mouthSmileLeft: 6.38889 per FAP unit of (+0.2 open_jaw +0.5 stretch_l_cornerlip_o +0.5
     * raise_l_cornerlip_o) */
    { { 3277, 0, 0, 0, 0, 8192, 0, 0, 0, 0, 0, 8192, 0 },
      0, 0, 104676, -150, 0, 1000, 0 },
    /* mouthSmileRight: 6.38889 per FAP unit of (+0.2 open_jaw +0.5 stretch_r_cornerlip_o +0.5
     * raise_r_cornerlip_o) */
    { { 3277, 0, 0, 0, 0, 0, 8192, 0, 0, 0, 0, 0, 8192 },
      0, 0, 104676, -150, 0, 1000, 0 },
    /* mouthFrownLeft: 4.4 per FAP unit of (-0.4 open_jaw -1 raise_l_cornerlip_o) */
    { { -3277, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, -8192, 0 },
      0, 0, 144179, -100, 0, 1000, 0 },
    /* mouthFrownRight: 4.4 per FAP unit of (-0.4 open_jaw -1 raise_r_cornerlip_o) */
    { { -3277, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, -8192 },
      0, 0, 144179, -100, 0, 1000, 0 },
    /* mouthUpperUpLeft: 5.5 per FAP unit of (-1 lower_t_lip_lm_o) */
    { { 0, 0, 0, 0, 0, 0, 0, -4096, 0, 0, 0, 0, 0 },
      0, 0, 360448, -100, 0, 1000, 0 },
    /* mouthUpperUpRight: 5.5 per FAP unit of (-1 lower_t_lip_rm_o) */
    { { 0, 0, 0, 0, 0, 0, 0, 0, -4096, 0, 0, 0, 0 },
      0, 0, 360448, -100, 0, 1000, 0 },
    /* mouthLowerDownLeft: 3.66667 per FAP unit of (-0.9 open_jaw -1 raise_b_lip_lm_o) */
    { { -7373, 0, 0, 0, 0, 0, 0, 0, 0, -8192, 0, 0, 0 },
      0, 0, 120149, -100, 0, 1000, 0 },
    /* mouthLowerDownRight: 3.66667 per FAP unit of (-0.9 open_jaw -1 raise_b_lip_rm_o) */
    { { -7373, 0, 0, 0, 0, 0, 0, 0, 0, 0, -8192, 0, 0 },
      0, 0, 120149, -100, 0, 1000, 0 },
    /* mouthPressLeft: 6.94444 per FAP unit of (+0.25 open_jaw +1.25 lower_t_midlip_o +0.25
     * raise_b_midlip_o) */
    { { 1024, 0, 0, 5120, 1024, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 455111, -250, 0, 700, 0 },
    /* mouthPressRight: 6.94444 per FAP unit of (+0.25 open_jaw +1.25 lower_t_midlip_o +0.25
     * raise_b_midlip_o) */
    { { 1024, 0, 0, 5120, 1024, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 455111, -250, 0, 700, 0 },
    /* mouthRollUpper: 5 per FAP unit of (+0.25 open_jaw +1.25 lower_t_midlip_o +0.25 raise_b_midlip_o) */
    { { 1024, 0, 0, 5120, 1024, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 327680, -250, 0, 500, 0 },
    /* mouthRollLower: 6.11111 per FAP unit of (+1 open_jaw +1 raise_b_midlip_o) */
    { { 4096, 0, 0, 0, 4096, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 400498, -100, 0, 1000, 0 },
    /* mouthShrugLower: 3.14286 per FAP unit of (+1 open_jaw +1 raise_b_midlip_o) */
    { { 4096, 0, 0, 0, 4096, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 205970, -100, 0, 500, 0 },
    /* mouthShrugUpper: 3.57143 per FAP unit of (+1 open_jaw -1 lower_t_midlip_o +1 raise_b_midlip_o) */
    { { 4096, 0, 0, -4096, 4096, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 234057, -250, 0, 500, 0 }
};

const labial_rig_t arkit = { outputs, 20 };
