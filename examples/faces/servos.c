/*
 * servos.c - what moves a face. Values are ticks of 4.88 us (PCA9685 with prescale register 121, 50.03 Hz).
 * Written by labial rig 0.4.0; do not edit.
 */
#include "servos.h"

/* weights, invert, contact, gain, neutral, minimum, maximum, slew, closed, deadband, acceleration, curve, visemes */
static const labial_rig_output_t outputs[5] = {
    /* jaw: 0.204918 per FAP unit of (+1 open_jaw), at most 25 per frame */
    { { 4096, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 13430, 298, 298, 379, 25, 0, 0, 0, 0, 0 },
    /* upper_lip: 0.34153 per FAP unit of (-1 lower_t_midlip_o) */
    { { 0, 0, 0, -4096, 0, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 22383, 307, 273, 338, 0, 0, 0, 0, 0, 0 },
    /* lower_lip: 0.163934 per FAP unit of (+1 open_jaw +1 raise_b_midlip_o) */
    { { 4096, 0, 0, 0, 4096, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 10744, 307, 267, 358, 0, 0, 0, 0, 0, 0 },
    /* corner_left: 0.348361 per FAP unit of (+0.2 open_jaw +0.5 stretch_l_cornerlip_o +0.5
     * raise_l_cornerlip_o) */
    { { 819, 0, 0, 0, 0, 2048, 0, 0, 0, 0, 0, 2048, 0 },
      0, 0, 22830, 307, 277, 352, 0, 0, 0, 0, 0, 0 },
    /* corner_right: 0.348361 per FAP unit of (+0.2 open_jaw +0.5 stretch_r_cornerlip_o +0.5
     * raise_r_cornerlip_o) */
    { { 819, 0, 0, 0, 0, 0, 2048, 0, 0, 0, 0, 0, 2048 },
      1, 0, 22830, 307, 263, 338, 0, 0, 0, 0, 0, 0 }
};

const labial_rig_t servos = { outputs, 5 };
