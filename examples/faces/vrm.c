/*
 * vrm.c - what moves a face. Values are weights, 1000 for 1. Written by labial rig 0.4.0; do not edit.
 */
#include "vrm.h"

static const int16_t aa_visemes[LABIAL_VISEMES] = { 0, -1000, 0, 0, -200, -100, -300, -400, -200, -300, 120, -400, -400, -500, -500 };

static const int16_t ih_visemes[LABIAL_VISEMES] = { 0, -1000, 400, 100, 350, 200, 100, 600, 300, 0, 0, 0, 750, -300, -300 };

static const int16_t ou_visemes[LABIAL_VISEMES] = { 0, -1000, 200, 0, 0, 0, 750, 0, 0, 300, 0, 0, 0, -700, 600 };

static const int16_t ee_visemes[LABIAL_VISEMES] = { 0, -1000, 0, 150, 0, 0, 0, 0, 0, 0, 0, 400, 0, 0, 0 };

static const int16_t oh_visemes[LABIAL_VISEMES] = { 0, -1000, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 650, 0 };

/* weights, invert, contact, gain, neutral, minimum, maximum, slew, closed, deadband, acceleration, curve, visemes */
static const labial_rig_output_t outputs[5] = {
    /* aa: 1.11301 per FAP unit of (-0.066 open_jaw -0.489 lower_t_midlip_o -1 raise_b_midlip_o), 0 where
     * lips touch, -1000 PP, -200 DD, -100 kk, -300 CH, -400 SS, -200 nn, -300 RR, +120 aa, -400 E, -400 ih,
     * -500 oh, -500 ou */
    { { -541, 0, 0, -4006, -8192, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 1, 36471, -107, 0, 1000, 0, 0, 0, 0, 0, aa_visemes },
    /* ih: 3.31895 per FAP unit of (-1 lower_t_midlip_o -0.064 stretch_l_cornerlip_o -0.064
     * stretch_r_cornerlip_o), -1000 PP, +400 FF, +100 TH, +350 DD, +200 kk, +100 CH, +600 SS, +300 nn, +750
     * ih, -300 oh, -300 ou */
    { { 0, 0, 0, -16384, 0, -1049, -1049, 0, 0, 0, 0, 0, 0 },
      0, 0, 54378, 0, 0, 1000, 0, 0, 0, 0, 0, ih_visemes },
    /* ou: 15.3333 per FAP unit of (-0.5 stretch_l_cornerlip_o -0.5 stretch_r_cornerlip_o), 0 where lips
     * touch, -1000 PP, +200 FF, +750 CH, +300 RR, -700 oh, +600 ou */
    { { 0, 0, 0, 0, 0, -2048, -2048, 0, 0, 0, 0, 0, 0 },
      0, 1, 1004885, -150, 0, 1000, 0, 0, 0, 0, 0, ou_visemes },
    /* ee: 0 per FAP unit of (), 0 where lips touch, -1000 PP, +150 TH, +400 E */
    { { 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 1, 0, 0, 0, 1000, 0, 0, 0, 0, 0, ee_visemes },
    /* oh: 0 per FAP unit of (), 0 where lips touch, -1000 PP, +650 oh */
    { { 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 1, 0, 0, 0, 1000, 0, 0, 0, 0, 0, oh_visemes }
};

const labial_rig_t vrm = { outputs, 5 };
