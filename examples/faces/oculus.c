/*
 * oculus.c - what moves a face. Values are thousandths of a weight. Written by labial rig 0.3.0; do not edit.
 */
#include "oculus.h"

/* weights, invert, reserved, gain, neutral, minimum, maximum, slew */
static const labial_rig_output_t outputs[15] = {
    /* sil: -5.98802 per FAP unit of (+0.5 open_jaw -1 raise_b_midlip_o) */
    { { 2048, 0, 0, 0, -4096, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, -392431, 1000, 0, 1000, 0 },
    /* PP: 10 per FAP unit of (+0.25 open_jaw +1.25 lower_t_midlip_o +0.25 raise_b_midlip_o) */
    { { 1024, 0, 0, 5120, 1024, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 655360, -300, 0, 1000, 0 },
    /* FF: 9 per FAP unit of (+1.25 open_jaw -1.5 lower_t_midlip_o +1.25 raise_b_midlip_o) */
    { { 5120, 0, 0, -6144, 5120, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 589824, -800, 0, 1000, 0 },
    /* TH: 2 per FAP unit of (-0.5 open_jaw -2 push_t_lip -1 lower_t_midlip_o -1 raise_b_midlip_o +1
     * stretch_l_cornerlip_o +1 stretch_r_cornerlip_o) */
    { { -2048, 0, -8192, -4096, -4096, 4096, 4096, 0, 0, 0, 0, 0, 0 },
      0, 0, 131072, -140, 0, 50, 0 },
    /* DD: 1.19956 per FAP unit of (-0.75 open_jaw -3 push_t_lip -1 lower_t_midlip_o -1 raise_b_midlip_o
     * +1.5 stretch_l_cornerlip_o +1.5 stretch_r_cornerlip_o) */
    { { -1536, 0, -6144, -2048, -2048, 3072, 3072, 0, 0, 0, 0, 0, 0 },
      0, 0, 157229, -100, 0, 100, 0 },
    /* kk: 2 per FAP unit of (-0.5 open_jaw -4 push_t_lip +1 lower_t_midlip_o -1 raise_b_midlip_o +2
     * stretch_l_cornerlip_o +2 stretch_r_cornerlip_o) */
    { { -2048, 0, -16384, 4096, -4096, 8192, 8192, 0, 0, 0, 0, 0, 0 },
      0, 0, 131072, -350, 0, 50, 0 },
    /* CH: 4.00552 per FAP unit of (-1 open_jaw -1.5 push_t_lip -2.5 lower_t_midlip_o -0.5 raise_b_midlip_o
     * -1.5 stretch_l_cornerlip_o -1.5 stretch_r_cornerlip_o) */
    { { -4096, 0, -6144, -10240, -2048, -6144, -6144, 0, 0, 0, 0, 0, 0 },
      0, 0, 262506, -450, 0, 500, 0 },
    /* SS: 4 per FAP unit of (-1 open_jaw -2 push_t_lip -3 lower_t_midlip_o -0.5 raise_b_midlip_o +1.5
     * stretch_l_cornerlip_o +1.5 stretch_r_cornerlip_o) */
    { { -4096, 0, -8192, -12288, -2048, 6144, 6144, 0, 0, 0, 0, 0, 0 },
      0, 0, 262144, -480, 0, 250, 0 },
    /* nn: 1.20042 per FAP unit of (-0.5 open_jaw -5 push_t_lip -1 lower_t_midlip_o -1 raise_b_midlip_o +2.5
     * stretch_l_cornerlip_o +2.5 stretch_r_cornerlip_o) */
    { { -1024, 0, -10240, -2048, -2048, 5120, 5120, 0, 0, 0, 0, 0, 0 },
      0, 0, 157341, -150, 0, 100, 0 },
    /* RR: 4 per FAP unit of (-0.25 open_jaw +2 push_t_lip -0.5 lower_t_midlip_o -0.25 raise_b_midlip_o -1
     * stretch_l_cornerlip_o -1 stretch_r_cornerlip_o) */
    { { -1024, 0, 8192, -2048, -1024, -4096, -4096, 0, 0, 0, 0, 0, 0 },
      0, 0, 262144, -300, 0, 100, 0 },
    /* aa: 3.25048 per FAP unit of (-4 push_t_lip +0.5 lower_t_midlip_o -1 raise_b_midlip_o -1.25
     * stretch_l_cornerlip_o -1.25 stretch_r_cornerlip_o) */
    { { 0, 0, -16384, 2048, -4096, -5120, -5120, 0, 0, 0, 0, 0, 0 },
      0, 0, 213023, -700, 0, 700, 0 },
    /* E: 2.99838 per FAP unit of (-1.25 push_t_lip -1.75 lower_t_midlip_o -0.5 raise_b_midlip_o +3
     * stretch_l_cornerlip_o +3 stretch_r_cornerlip_o) */
    { { 0, 0, -5120, -7168, -2048, 12288, 12288, 0, 0, 0, 0, 0, 0 },
      0, 0, 196502, -850, 0, 200, 0 },
    /* ih: 3.49754 per FAP unit of (-1.25 open_jaw -2 push_t_lip -3.5 lower_t_midlip_o -1 raise_b_midlip_o
     * +1 stretch_l_cornerlip_o +1 stretch_r_cornerlip_o) */
    { { -2560, 0, -4096, -7168, -2048, 2048, 2048, 0, 0, 0, 0, 0, 0 },
      0, 0, 458429, -420, 0, 150, 0 },
    /* oh: 2 per FAP unit of (+2 push_t_lip -1 lower_t_midlip_o -1 raise_b_midlip_o -1 stretch_l_cornerlip_o
     * -1 stretch_r_cornerlip_o) */
    { { 0, 0, 8192, -4096, -4096, -4096, -4096, 0, 0, 0, 0, 0, 0 },
      0, 0, 131072, -1160, 0, 600, 0 },
    /* ou: 3.00231 per FAP unit of (-1.5 open_jaw +4 push_t_lip -2.125 lower_t_midlip_o -0.875
     * raise_b_midlip_o -2 stretch_l_cornerlip_o -2 stretch_r_cornerlip_o) */
    { { -3072, 0, 8192, -4352, -1792, -4096, -4096, 0, 0, 0, 0, 0, 0 },
      0, 0, 393519, -300, 0, 500, 0 }
};

const labial_rig_t oculus = { outputs, 15 };
