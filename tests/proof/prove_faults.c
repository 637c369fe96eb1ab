/* What every proof relies on: that each of these faults is an alarm. */
#include "prove.h"

static int overflow(int value)
{
    return value + 1;
}

static int beyond(const uint8_t *bytes, unsigned i)
{
    return bytes[i];
}

static int shifted(unsigned bits)
{
    return (int)(1u << bits);
}

static unsigned divided(unsigned by)
{
    return 1u / by;
}

static const uint8_t *outside(const uint8_t *bytes, unsigned i)
{
    return bytes + i;
}

int main(void)
{
    const uint8_t bytes[4] = { 1, 2, 3, 4 };
    int never, sum = overflow(any_int) != 0;
    sum += beyond(bytes, (unsigned)Frama_C_interval(0, 4)) != 0;
    sum += shifted((unsigned)Frama_C_interval(0, 32)) != 0;
    sum += divided(any_unsigned) != 0;
    sum += outside(bytes, (unsigned)Frama_C_interval(0, 5)) != 0;
    if (any_int)
        never = 0;
    return sum + (never != 0);
}
