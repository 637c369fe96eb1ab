/*
 * oculus.c - what moves a face. Values are weights, 1000 for 1. Written by labial rig 0.4.0; do not edit.
 */
#include "oculus.h"

static const int16_t sil_visemes[LABIAL_VISEMES] = { 0, -1000, -1000, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 };

static const int16_t PP_visemes[LABIAL_VISEMES] = { 0, 1200, -1000, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 };

static const int16_t FF_visemes[LABIAL_VISEMES] = { -1000, -1000, 1250, 0, 0, 0, 0, -1000, 0, 0, 0, 0, 0, 0, 0 };

static const int16_t TH_visemes[LABIAL_VISEMES] = { 0, 0, 0, 950, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 };

static const int16_t DD_visemes[LABIAL_VISEMES] = { 0, 0, 0, 0, 650, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 };

static const int16_t kk_visemes[LABIAL_VISEMES] = { 0, 0, 0, 0, 0, 600, 0, 0, 0, 0, 0, 0, 0, 0, 0 };

static const int16_t CH_visemes[LABIAL_VISEMES] = { 0, 0, 0, 0, 0, 0, 950, 0, 0, 0, 0, 0, 0, 0, 0 };

static const int16_t SS_visemes[LABIAL_VISEMES] = { 0, -1000, -1000, -1000, -400, 0, -1000, 800, -300, -500, -500, -500, -500, 0, 0 };

static const int16_t nn_visemes[LABIAL_VISEMES] = { 0, 0, 0, 0, 0, 0, 0, 0, 650, 0, 0, 0, 0, 0, 0 };

static const int16_t RR_visemes[LABIAL_VISEMES] = { 0, 0, 0, 0, 0, 0, 0, 0, 0, 700, 0, 0, 0, 0, 0 };

static const int16_t aa_visemes[LABIAL_VISEMES] = { 0, -1000, 0, -150, -200, -200, -250, -300, -200, -200, 100, -250, -300, -450, -350 };

static const int16_t E_visemes[LABIAL_VISEMES] = { 0, -1000, 0, 0, 0, 0, 0, 0, 0, 0, 0, 650, 0, 0, 0 };

static const int16_t ih_visemes[LABIAL_VISEMES] = { 0, -1000, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 750, 0, 0 };

static const int16_t oh_visemes[LABIAL_VISEMES] = { 0, -1000, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 600, 0 };

static const int16_t ou_visemes[LABIAL_VISEMES] = { 0, -1000, 0, 0, 0, 0, -200, 0, 0, -400, 0, 0, 0, -600, 600 };

/* weights, invert, contact, gain, neutral, minimum, maximum, slew, closed, deadband, acceleration, curve, visemes */
static const labial_rig_output_t outputs[15] = {
    /* sil: -5.98802 per FAP unit of (+0.5 open_jaw -1 raise_b_midlip_o), -1000 PP, -1000 FF */
    { { 2048, 0, 0, 0, -4096, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, -392431, 1000, 0, 1000, 0, 0, 0, 0, 0, sil_visemes },
    /* PP: 16.6667 per FAP unit of (+1 lower_t_midlip_o +0.3 raise_b_midlip_o), +1200 PP, -1000 FF */
    { { 0, 0, 0, 16384, 4915, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 273067, 0, 0, 1000, 0, 0, 0, 0, 0, PP_visemes },
    /* FF: 19.3548 per FAP unit of (+0.5 open_jaw -1 lower_t_midlip_o +1 raise_b_midlip_o), -1000 sil, -1000
     * PP, +1250 FF, -1000 SS */
    { { 2048, 0, 0, -4096, 4096, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 1268439, -200, 0, 1000, 0, 0, 0, 0, 0, FF_visemes },
    /* TH: 0 per FAP unit of (), 0 where lips touch, +950 TH */
    { { 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 1, 0, 0, 0, 1000, 0, 0, 0, 0, 0, TH_visemes },
    /* DD: 0 per FAP unit of (), 0 where lips touch, +650 DD */
    { { 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 1, 0, 0, 0, 1000, 0, 0, 0, 0, 0, DD_visemes },
    /* kk: 0 per FAP unit of (), 0 where lips touch, +600 kk */
    { { 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 1, 0, 0, 0, 1000, 0, 0, 0, 0, 0, kk_visemes },
    /* CH: 0 per FAP unit of (), 0 where lips touch, +950 CH */
    { { 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 1, 0, 0, 0, 1000, 0, 0, 0, 0, 0, CH_visemes },
    /* SS: 15.7143 per FAP unit of (-1 lower_t_midlip_o +0.2 raise_b_midlip_o), 0 where lips touch, -1000
     * PP, -1000 FF, -1000 TH, -400 DD, -1000 CH, +800 SS, -300 nn, -500 RR, -500 aa, -500 E, -500 ih */
    { { 0, 0, 0, -16384, 3277, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 1, 257463, -100, 0, 1000, 0, 0, 0, 0, 0, SS_visemes },
    /* nn: 0 per FAP unit of (), 0 where lips touch, +650 nn */
    { { 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 1, 0, 0, 0, 1000, 0, 0, 0, 0, 0, nn_visemes },
    /* RR: 0 per FAP unit of (), 0 where lips touch, +700 RR */
    { { 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 1, 0, 0, 0, 1000, 0, 0, 0, 0, 0, RR_visemes },
    /* aa: 1.12989 per FAP unit of (-0.122 open_jaw -0.472 lower_t_midlip_o -1 raise_b_midlip_o), 0 where
     * lips touch, -1000 PP, -150 TH, -200 DD, -200 kk, -250 CH, -300 SS, -200 nn, -200 RR, +100 aa, -250 E,
     * -300 ih, -450 oh, -350 ou */
    { { -1999, 0, 0, -7733, -16384, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 1, 18512, -86, 0, 1000, 0, 0, 0, 0, 0, aa_visemes },
    /* E: 0 per FAP unit of (), 0 where lips touch, -1000 PP, +650 E */
    { { 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 1, 0, 0, 0, 1000, 0, 0, 0, 0, 0, E_visemes },
    /* ih: 0 per FAP unit of (), 0 where lips touch, -1000 PP, +750 ih */
    { { 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 1, 0, 0, 0, 1000, 0, 0, 0, 0, 0, ih_visemes },
    /* oh: 0 per FAP unit of (), 0 where lips touch, -1000 PP, +600 oh */
    { { 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 1, 0, 0, 0, 1000, 0, 0, 0, 0, 0, oh_visemes },
    /* ou: 15.3333 per FAP unit of (-0.5 stretch_l_cornerlip_o -0.5 stretch_r_cornerlip_o), -1000 PP, -200
     * CH, -400 RR, -600 oh, +600 ou */
    { { 0, 0, 0, 0, 0, -2048, -2048, 0, 0, 0, 0, 0, 0 },
      0, 0, 1004885, -150, 0, 1000, 0, 0, 0, 0, 0, ou_visemes }
};

const labial_rig_t oculus = { outputs, 15 };
