/*
 * oculus.c - what moves a face. Values are weights, 1000 for 1. Written by labial rig 0.4.0; do not edit.
 */
#include "oculus.h"

/* weights, invert, contact, gain, neutral, minimum, maximum, slew, closed, deadband, acceleration, curve */
static const labial_rig_output_t outputs[10] = {
    /* sil: -5.98802 per FAP unit of (+0.5 open_jaw -1 raise_b_midlip_o) */
    { { 2048, 0, 0, 0, -4096, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, -392431, 1000, 0, 1000, 0, 0, 0, 0, 0 },
    /* PP: 8.2842 per FAP unit of (+1 lower_t_midlip_o +0.274 raise_b_midlip_o) */
    { { 0, 0, 0, 16384, 4489, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 135728, -96, 0, 1000, 0, 0, 0, 0, 0 },
    /* FF: 5.87965 per FAP unit of (+0.714 open_jaw -1 lower_t_midlip_o +0.714 raise_b_midlip_o) */
    { { 5849, 0, 0, -8192, 5849, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 192664, -280, 0, 250, 0, 0, 0, 0, 0 },
    /* TH: 4 per FAP unit of (-0.25 open_jaw -1 push_t_lip -0.5 lower_t_midlip_o -0.5 raise_b_midlip_o +0.5
     * stretch_l_cornerlip_o +0.5 stretch_r_cornerlip_o) */
    { { -1024, 0, -4096, -2048, -2048, 2048, 2048, 0, 0, 0, 0, 0, 0 },
      0, 0, 262144, -140, 0, 50, 0, 0, 0, 0, 0 },
    /* DD: 3.5983 per FAP unit of (-0.25 open_jaw -1 push_t_lip -0.333 lower_t_midlip_o -0.333
     * raise_b_midlip_o +0.5 stretch_l_cornerlip_o +0.5 stretch_r_cornerlip_o) */
    { { -1024, 0, -4096, -1364, -1364, 2048, 2048, 0, 0, 0, 0, 0, 0 },
      0, 0, 235818, -100, 0, 50, 0, 0, 0, 0, 0 },
    /* kk: 7.99763 per FAP unit of (-0.125 open_jaw -1 push_t_lip +0.25 lower_t_midlip_o -0.25
     * raise_b_midlip_o +0.5 stretch_l_cornerlip_o +0.5 stretch_r_cornerlip_o) */
    { { -512, 0, -4096, 1024, -1024, 2048, 2048, 0, 0, 0, 0, 0, 0 },
      0, 0, 524133, -350, 0, 50, 0, 0, 0, 0, 0 },
    /* nn: 6.00209 per FAP unit of (-0.1 open_jaw -1 push_t_lip -0.2 lower_t_midlip_o -0.2 raise_b_midlip_o
     * +0.5 stretch_l_cornerlip_o +0.5 stretch_r_cornerlip_o) */
    { { -1638, 0, -16384, -3277, -3277, 8192, 8192, 0, 0, 0, 0, 0, 0 },
      0, 0, 98338, -150, 0, 50, 0, 0, 0, 0, 0 },
    /* aa: 1.12989 per FAP unit of (-0.122 open_jaw -0.472 lower_t_midlip_o -1 raise_b_midlip_o) */
    { { -1999, 0, 0, -7733, -16384, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 18512, -86, 0, 1000, 0, 0, 0, 0, 0 },
    /* oh: 1.54358 per FAP unit of (-0.5 stretch_l_cornerlip_o -0.5 stretch_r_cornerlip_o) */
    { { 0, 0, 0, 0, 0, -2048, -2048, 0, 0, 0, 0, 0, 0 },
      0, 0, 101160, -20, 0, 1000, 0, 0, 0, 0, 0 },
    /* ou: 3.10811 per FAP unit of (+1 push_t_lip -0.5 lower_t_midlip_o +0.1 raise_b_midlip_o -0.5
     * stretch_l_cornerlip_o -0.5 stretch_r_cornerlip_o) */
    { { 0, 0, 8192, -4096, 819, -4096, -4096, 0, 0, 0, 0, 0, 0 },
      0, 0, 101846, -150, 0, 1000, 0, 0, 0, 0, 0 }
};

const labial_rig_t oculus = { outputs, 10 };
