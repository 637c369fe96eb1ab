/*
 * vrm.c - what moves a face. Values are weights, 1000 for 1. Written by labial rig 0.4.0; do not edit.
 */
#include "vrm.h"

/* weights, invert, contact, gain, neutral, minimum, maximum, slew, closed, deadband, acceleration, curve */
static const labial_rig_output_t outputs[3] = {
    /* aa: 1.11301 per FAP unit of (-0.066 open_jaw -0.489 lower_t_midlip_o -1 raise_b_midlip_o) */
    { { -541, 0, 0, -4006, -8192, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 36471, -107, 0, 1000, 0, 0, 0, 0, 0 },
    /* ih: 3.31895 per FAP unit of (-1 lower_t_midlip_o -0.064 stretch_l_cornerlip_o -0.064
     * stretch_r_cornerlip_o) */
    { { 0, 0, 0, -16384, 0, -1049, -1049, 0, 0, 0, 0, 0, 0 },
      0, 0, 54378, 0, 0, 1000, 0, 0, 0, 0, 0 },
    /* ou: 3.10811 per FAP unit of (+1 push_t_lip -0.5 lower_t_midlip_o +0.1 raise_b_midlip_o -0.5
     * stretch_l_cornerlip_o -0.5 stretch_r_cornerlip_o) */
    { { 0, 0, 8192, -4096, 819, -4096, -4096, 0, 0, 0, 0, 0, 0 },
      0, 0, 101846, -150, 0, 1000, 0, 0, 0, 0, 0 }
};

const labial_rig_t vrm = { outputs, 3 };
