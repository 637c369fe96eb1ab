/* The shared arithmetic, with any operands within the ranges that fixed.h names. */
#include "fixed.h"

#include "prove.h"

int main(void)
{
    const unsigned steps = (unsigned)Frama_C_interval(1, 65535);
    const int32_t limit = Frama_C_interval(0, INT32_MAX);
    labial_add(any_int32, any_int32);
    labial_sub(any_int32, any_int32);
    labial_mulshift(any_int32, any_int32, (unsigned)Frama_C_interval(16, 31));
    labial_part16(any_int32, Frama_C_unsigned_int_interval(0, 65536));
    labial_part24(any_int32, Frama_C_unsigned_int_interval(0, (1u << 24) - 1u));
    labial_part24(any_int32, 1u << 24);
    labial_weight(any_uint8);
    labial_z(Frama_C_unsigned_int_interval(0, 65535), any_uint16, Frama_C_unsigned_int_interval(0, 65535));
    labial_z_cost(Frama_C_unsigned_int_interval(0, 65535));
    labial_ease(Frama_C_unsigned_int_interval(0, 65535), steps);
    return labial_clamp(any_int32, limit);
}
