/*
 * face.c - what moves a face. Values are microseconds. Written by labial rig 0.4.0; do not edit.
 */
#include "face.h"

/* weights, invert, contact, gain, neutral, minimum, maximum, slew, closed, deadband, acceleration, curve, visemes */
static const labial_rig_output_t outputs[3] = {
    /* jaw: 0.892857 per FAP unit of (-1 raise_b_midlip_o), at most 160 per frame, 1400 where lips touch */
    { { 0, 0, 0, 0, -4096, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 1, 58514, 1400, 1400, 1900, 160, 1400, 0, 0, 0, 0 },
    /* upper_lip: 2.22222 per FAP unit of (-1 lower_t_midlip_o), at most 160 per frame */
    { { 0, 0, 0, -4096, 0, 0, 0, 0, 0, 0, 0, 0, 0 },
      0, 0, 145636, 1500, 1290, 1700, 160, 0, 0, 0, 0, 0 },
    /* corners: 2.08333 per FAP unit of (+0.2 open_jaw +0.25 stretch_l_cornerlip_o +0.25
     * stretch_r_cornerlip_o +0.25 raise_l_cornerlip_o +0.25 raise_r_cornerlip_o), at most 160 per frame */
    { { 3277, 0, 0, 0, 0, 4096, 4096, 0, 0, 0, 0, 4096, 4096 },
      0, 0, 34133, 1500, 1300, 1780, 160, 0, 0, 0, 0, 0 }
};

const labial_rig_t face = { outputs, 3 };
