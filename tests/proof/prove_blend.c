/* Any description, intensity, share of words and frames; the result apart from them or in place of either. */
#include "labial/blend.h"

#include "prove.h"

int main(void)
{
    labial_blend_t blend;
    int16_t speech[LABIAL_CHANNELS], laugh[LABIAL_CHANNELS], out[LABIAL_CHANNELS];
    int16_t *to = any_int ? out : any_int ? speech : any_int ? laugh : (int16_t *)0;
    FILL(blend);
    FILL(speech);
    FILL(laugh);
    labial_blend(OR_NULL(const labial_blend_t *, any_int ? &labial_blend_default : &blend), any_unsigned, any_unsigned,
                 OR_NULL(const int16_t *, speech), OR_NULL(const int16_t *, laugh), to);
    return 0;
}
