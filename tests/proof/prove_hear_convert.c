/*
 * Any rate; for each that there is, any samples, the first one and others at any place of the ring, at every phase:
 * those of one distance from the grid together, so that the filter's magnitudes add up to what they are.
 */
#include "hear_parts.h"

#include "prove.h"

static labial_hear_convert_t convert;
static int16_t out[LABIAL_HEAR_CONVERTED_MAX];

/* Any sample at the phases from `least` to `most`. */
static void take(unsigned least, unsigned most)
{
    FILL(convert.past);
    convert.at = (uint8_t)Frama_C_interval(0, LABIAL_HEAR_TAPS_);
    labial_hear_convert_last(&convert);
    convert.phase = (uint16_t)Frama_C_interval((int)least, (int)most);
    labial_hear_convert(&convert, any_int16, out);
}

static void convert_from(uint32_t rate)
{
    unsigned stride, point, points;
    if (labial_hear_convert_init(&convert, rate) != LABIAL_OK || convert.reach == 0)
        return;
    stride = convert.spacing * 10u;
    points = convert.spacing + convert.step / 10u;
    /*@ loop unroll 100; */
    for (point = convert.spacing; point <= points; point++)
        take(point == convert.spacing ? stride : 10u * point - 5u,
             point == points ? stride + convert.step - 1u : 10u * point + 4u);
}

int main(void)
{
    static const uint32_t rates[] = { 8000, 12000, 16000, 22050, 24000, 32000, 44100, 48000 };
    unsigned i;
    labial_hear_convert_init(&convert, any_uint32);
    /*@ loop unroll 8; */
    for (i = 0; i < sizeof rates / sizeof rates[0]; i++)
        convert_from(rates[i]);
    return 0;
}
