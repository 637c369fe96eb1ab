/*
 * vrm.c - what moves a face. Values are thousandths of a weight. Written by labial rig 0.3.0; do not edit.
 */
#include "vrm.h"

/* weights, invert, reserved, gain, neutral, minimum, maximum, slew */
static const labial_rig_output_t outputs[5] = {
    /* aa: 3.24803 per FAP unit of (-4 push_t_lip +0.5 lower_t_midlip_o -1 raise_b_midlip_o -1.25
     * stretch_l_cornerlip_o -1.25 stretch_r_cornerlip_o) */
    { { 0, 0, -16384, 2048, -4096, -5120, -5120, 0, 0, 0, 0, 0, 0 },
      0, 0, 212863, -650, 0, 800, 0 },
    /* ih: 3.49754 per FAP unit of (-1.25 open_jaw -2 push_t_lip -3.5 lower_t_midlip_o -1 raise_b_midlip_o
     * +1 stretch_l_cornerlip_o +1 stretch_r_cornerlip_o) */
    { { -2560, 0, -4096, -7168, -2048, 2048, 2048, 0, 0, 0, 0, 0, 0 },
      0, 0, 458429, -420, 0, 350, 0 },
    /* ou: 2.9976 per FAP unit of (-1.5 open_jaw +4 push_t_lip -2.125 lower_t_midlip_o -0.875
     * raise_b_midlip_o -2 stretch_l_cornerlip_o -2 stretch_r_cornerlip_o) */
    { { -6144, 0, 16384, -8704, -3584, -8192, -8192, 0, 0, 0, 0, 0, 0 },
      0, 0, 196451, -250, 0, 600, 0 },
    /* ee: 2.99838 per FAP unit of (-1.25 push_t_lip -1.75 lower_t_midlip_o -0.5 raise_b_midlip_o +3
     * stretch_l_cornerlip_o +3 stretch_r_cornerlip_o) */
    { { 0, 0, -5120, -7168, -2048, 12288, 12288, 0, 0, 0, 0, 0, 0 },
      0, 0, 196502, -850, 0, 300, 0 },
    /* oh: 2 per FAP unit of (+2 push_t_lip -1 lower_t_midlip_o -1 raise_b_midlip_o -1 stretch_l_cornerlip_o
     * -1 stretch_r_cornerlip_o) */
    { { 0, 0, 8192, -4096, -4096, -4096, -4096, 0, 0, 0, 0, 0, 0 },
      0, 0, 131072, -1160, 0, 700, 0 }
};

const labial_rig_t vrm = { outputs, 5 };
