/*
 * vrm.c - what moves a face. Values are plain units. Written by labial rig 0.2.0; do not edit.
 */
#include "vrm.h"

/* weights, invert, reserved, gain, neutral, minimum, maximum, slew */
static const labial_rig_output_t outputs[5] = {
    /* aa: 3.25 per FAP unit of (-5.5 push_t_lip +0.5 lower_t_midlip_o -1 raise_b_midlip_o -1.25
     * stretch_l_cornerlip_o -1.25 stretch_r_cornerlip_o) */
    { { 0, 0, -22528, 2048, -4096, -5120, -5120, 0, 0, 0, 0, 0, 0 },
      0, 0, 212992, -650, 0, 850, 0 },
    /* ih: 3 per FAP unit of (-1.75 open_jaw -3 push_t_lip -4 lower_t_midlip_o -1 raise_b_midlip_o +1.5
     * stretch_l_cornerlip_o +1.5 stretch_r_cornerlip_o) */
    { { -7168, 0, -12288, -16384, -4096, 6144, 6144, 0, 0, 0, 0, 0, 0 },
      0, 0, 196608, 0, 0, 400, 0 },
    /* ou: 3 per FAP unit of (-2.25 open_jaw +4 push_t_lip -1.5 lower_t_midlip_o -1.5 raise_b_midlip_o -2
     * stretch_l_cornerlip_o -2 stretch_r_cornerlip_o) */
    { { -9216, 0, 16384, -6144, -6144, -8192, -8192, 0, 0, 0, 0, 0, 0 },
      0, 0, 196608, -200, 0, 600, 0 },
    /* ee: 3 per FAP unit of (-1.25 push_t_lip -1.75 lower_t_midlip_o -0.5 raise_b_midlip_o +3
     * stretch_l_cornerlip_o +3 stretch_r_cornerlip_o) */
    { { 0, 0, -5120, -7168, -2048, 12288, 12288, 0, 0, 0, 0, 0, 0 },
      0, 0, 196608, -850, 0, 300, 0 },
    /* oh: 2.6 per FAP unit of (+5 push_t_lip -2 lower_t_midlip_o -1 raise_b_midlip_o -2.5
     * stretch_l_cornerlip_o -2.5 stretch_r_cornerlip_o) */
    { { 0, 0, 10240, -4096, -2048, -5120, -5120, 0, 0, 0, 0, 0, 0 },
      0, 0, 340787, -1850, 0, 700, 0 }
};

const labial_rig_t vrm = { outputs, 5 };
