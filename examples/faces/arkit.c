/*
 * arkit.c - what moves a face. Values are weights, 1000 for 1. Written by labial rig 0.4.0; do not edit.
 */
#include "arkit.h"

static const int16_t jawOpen_visemes[LABIAL_VISEMES] = { 0, 0, 30, 60, 0, 0, -100, -80, 0, 0, 30, 0, 0, -60, -30 };

static const int16_t mouthClose_visemes[LABIAL_VISEMES] = { 0, 0, -150, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 };

static const int16_t mouthPucker_visemes[LABIAL_VISEMES] = { 0, 0, -100, 0, 0, 0, 300, 0, 0, 150, 0, 0, 0, 100, 250 };

static const int16_t mouthSmileLeft_visemes[LABIAL_VISEMES] = { 0, 0, 0, 0, 0, 0, 0, 100, 0, 0, 0, 150, 250, 0, 0 };

static const int16_t mouthSmileRight_visemes[LABIAL_VISEMES] = { 0, 0, 0, 0, 0, 0, 0, 100, 0, 0, 0, 150, 250, 0, 0 };

static const int16_t mouthStretchLeft_visemes[LABIAL_VISEMES] = { 0, 0, 0, 0, 0, 0, 0, 200, 0, 0, 0, 100, 200, 0, 0 };

static const int16_t mouthStretchRight_visemes[LABIAL_VISEMES] = { 0, 0, 0, 0, 0, 0, 0, 200, 0, 0, 0, 100, 200, 0, 0 };

static const int16_t mouthUpperUpLeft_visemes[LABIAL_VISEMES] = { 0, 0, 455, 200, 0, 0, 120, 220, 0, 0, 0, 100, 100, 0, 0 };

static const int16_t mouthUpperUpRight_visemes[LABIAL_VISEMES] = { 0, 0, 455, 200, 0, 0, 120, 220, 0, 0, 0, 100, 100, 0, 0 };

static const int16_t mouthRollLower_visemes[LABIAL_VISEMES] = { 0, 250, 450, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 };

static const int16_t mouthRollUpper_visemes[LABIAL_VISEMES] = { 0, 300, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 };

static const int16_t mouthPressLeft_visemes[LABIAL_VISEMES] = { 0, 550, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 };

static const int16_t mouthPressRight_visemes[LABIAL_VISEMES] = { 0, 550, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 };

static const int16_t mouthFunnel_visemes[LABIAL_VISEMES] = { 0, 0, 0, 0, 0, 0, 400, 0, 0, 120, 0, 0, 0, 180, 80 };

static const int16_t mouthLowerDownLeft_visemes[LABIAL_VISEMES] = { 0, 0, 0, 300, 150, 0, 150, 450, 100, 0, 0, 150, 250, 0, 0 };

static const int16_t mouthLowerDownRight_visemes[LABIAL_VISEMES] = { 0, 0, 0, 300, 150, 0, 150, 450, 100, 0, 0, 150, 250, 0, 0 };

static const int16_t tongueOut_visemes[LABIAL_VISEMES] = { 0, 0, 0, 400, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 };

/* weights, invert, contact, gain, neutral, minimum, maximum, slew, closed, deadband, acceleration, curve, visemes */
static const labial_rig_output_t outputs[17] = {
    /* jawOpen: 0.525222 per FAP unit of (+0.222 open_jaw -1 lower_t_midlip_o -0.872 raise_b_midlip_o), +30
     * FF, +60 TH, -100 CH, -80 SS, +30 aa, -60 oh, -30 ou */
    { { 3637, 0, 0, -16384, -14287, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 8605, -34, 0, 1000, 0, 0, 0, 0, 0, jawOpen_visemes },
    /* mouthClose: 0.36762 per FAP unit of (+0.251 open_jaw +1 lower_t_midlip_o +0.305 raise_b_midlip_o),
     * -150 FF */
    { { 1028, 0, 0, 4096, 1249, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 24092, 0, 0, 1000, 0, 0, 0, 0, 0, mouthClose_visemes },
    /* mouthPucker: 4.66636 per FAP unit of (+0.038 push_b_lip +0.128 push_t_lip -0.5 stretch_l_cornerlip_o
     * -0.5 stretch_r_cornerlip_o), -100 FF, +300 CH, +150 RR, +100 oh, +250 ou */
    { { 0, 1245, 4194, 0, 0, -16384, -16384, 0, 0, 0, 0, 0, 0 },
      0, 0, 38227, 0, 0, 1000, 0, 0, 0, 0, 0, mouthPucker_visemes },
    /* mouthSmileLeft: 3.75657 per FAP unit of (+0.035 open_jaw +1 stretch_l_cornerlip_o -0.04
     * raise_l_cornerlip_o), +100 SS, +150 E, +250 ih */
    { { 573, 0, 0, 0, 0, 16384, 0, 0, 0, 0, 0, -655, 0 },
      0, 0, 61548, 0, 0, 1000, 0, 0, 0, 0, 0, mouthSmileLeft_visemes },
    /* mouthSmileRight: 3.75657 per FAP unit of (+0.035 open_jaw +1 stretch_r_cornerlip_o -0.04
     * raise_r_cornerlip_o), +100 SS, +150 E, +250 ih */
    { { 573, 0, 0, 0, 0, 0, 16384, 0, 0, 0, 0, 0, -655 },
      0, 0, 61548, 0, 0, 1000, 0, 0, 0, 0, 0, mouthSmileRight_visemes },
    /* mouthStretchLeft: 4.52127 per FAP unit of (+1 stretch_l_cornerlip_o -0.083 raise_l_cornerlip_o), +200
     * SS, +100 E, +200 ih */
    { { 0, 0, 0, 0, 0, 4096, 0, 0, 0, 0, 0, -340, 0 },
      0, 0, 296306, -10, 0, 1000, 0, 0, 0, 0, 0, mouthStretchLeft_visemes },
    /* mouthStretchRight: 4.52127 per FAP unit of (+1 stretch_r_cornerlip_o -0.083 raise_r_cornerlip_o),
     * +200 SS, +100 E, +200 ih */
    { { 0, 0, 0, 0, 0, 0, 4096, 0, 0, 0, 0, 0, -340 },
      0, 0, 296306, -10, 0, 1000, 0, 0, 0, 0, 0, mouthStretchRight_visemes },
    /* mouthUpperUpLeft: 1.62251 per FAP unit of (-1 lower_t_midlip_o -0.15 raise_b_midlip_o), +455 FF, +200
     * TH, +120 CH, +220 SS, +100 E, +100 ih */
    { { 0, 0, 0, -16384, -2458, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 26583, -77, 0, 1000, 0, 0, 0, 0, 0, mouthUpperUpLeft_visemes },
    /* mouthUpperUpRight: 1.62251 per FAP unit of (-1 lower_t_midlip_o -0.15 raise_b_midlip_o), +455 FF,
     * +200 TH, +120 CH, +220 SS, +100 E, +100 ih */
    { { 0, 0, 0, -16384, -2458, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 26583, -77, 0, 1000, 0, 0, 0, 0, 0, mouthUpperUpRight_visemes },
    /* mouthRollLower: 9.23077 per FAP unit of (+0.5 open_jaw -1 lower_t_midlip_o +1 raise_b_midlip_o), +250
     * PP, +450 FF */
    { { 2048, 0, 0, -4096, 4096, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 604948, -200, 0, 700, 0, 0, 0, 0, 0, mouthRollLower_visemes },
    /* mouthRollUpper: 0 per FAP unit of (), +300 PP */
    { { 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 0, 0, 0, 1000, 0, 0, 0, 0, 0, mouthRollUpper_visemes },
    /* mouthPressLeft: 0 per FAP unit of (), +550 PP */
    { { 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 0, 0, 0, 1000, 0, 0, 0, 0, 0, mouthPressLeft_visemes },
    /* mouthPressRight: 0 per FAP unit of (), +550 PP */
    { { 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 0, 0, 0, 1000, 0, 0, 0, 0, 0, mouthPressRight_visemes },
    /* mouthFunnel: 0 per FAP unit of (), +400 CH, +120 RR, +180 oh, +80 ou */
    { { 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 0, 0, 0, 1000, 0, 0, 0, 0, 0, mouthFunnel_visemes },
    /* mouthLowerDownLeft: 0 per FAP unit of (), 0 where lips touch, +300 TH, +150 DD, +150 CH, +450 SS,
     * +100 nn, +150 E, +250 ih */
    { { 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 1, 0, 0, 0, 1000, 0, 0, 0, 0, 0, mouthLowerDownLeft_visemes },
    /* mouthLowerDownRight: 0 per FAP unit of (), 0 where lips touch, +300 TH, +150 DD, +150 CH, +450 SS,
     * +100 nn, +150 E, +250 ih */
    { { 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 1, 0, 0, 0, 1000, 0, 0, 0, 0, 0, mouthLowerDownRight_visemes },
    /* tongueOut: 0 per FAP unit of (), 0 where lips touch, +400 TH */
    { { 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 1, 0, 0, 0, 1000, 0, 0, 0, 0, 0, tongueOut_visemes }
};

const labial_rig_t arkit = { outputs, 17 };
