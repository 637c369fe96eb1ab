"""The 13 channels of a frame: MPEG-4 facial animation parameters (ISO/IEC 14496-2) of jaw and outer lips."""

from __future__ import annotations

#: FAP number of each channel.
FAP_NUMBERS = (3, 16, 17, 51, 52, 53, 54, 55, 56, 57, 58, 59, 60)
#: MPEG-4 name of each channel. Units are 1/1024 of MNS (mouth-nose separation), of MW (mouth width) for 53 and 54.
FAP_NAMES = ("open_jaw", "push_b_lip", "push_t_lip", "lower_t_midlip_o", "raise_b_midlip_o", "stretch_l_cornerlip_o",
             "stretch_r_cornerlip_o", "lower_t_lip_lm_o", "lower_t_lip_rm_o", "raise_b_lip_lm_o", "raise_b_lip_rm_o",
             "raise_l_cornerlip_o", "raise_r_cornerlip_o")
#: Column names of a frames file, after ``time``.
FAP_COLUMNS = tuple(f"fap{number}" for number in FAP_NUMBERS)
#: Channels of a frame.
CHANNELS = len(FAP_NUMBERS)
#: Channels of the left and of the right side of the mouth that belong together.
SIDES = tuple((FAP_NUMBERS.index(left), FAP_NUMBERS.index(left + 1)) for left in (53, 55, 57, 59))
#: Opening up to which lips touch, -(FAP 51 + FAP 52): the outer lips are slightly apart when the inner ones meet
#: (LABIAL_RIG_TOUCHING of include/labial/rig.h).
TOUCHING = 72
