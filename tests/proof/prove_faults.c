/* What every proof relies on: that each of these faults is an alarm. */
#include "prove.h"

int main(void)
{
    const uint8_t bytes[4] = { 1, 2, 3, 4 };
    int never, sum = any_int + 1 != 0; /* an overflow */
    sum += bytes[Frama_C_interval(0, 4)] != 0;
    sum += (int)(1u << Frama_C_interval(0, 32)) != 0;
    sum += 1u / any_unsigned != 0;
    sum += bytes + Frama_C_interval(0, 5) != 0;
    if (any_int)
        never = 0;
    return sum + (never != 0);
}
