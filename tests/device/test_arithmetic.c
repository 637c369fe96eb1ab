/*
 * test_arithmetic.c - what the compiler and the processor make of lib/fixed.h and of the C that the library relies on.
 */
#include "device.h"

#include "fixed.h"

/* Values that the compiler cannot compute with before the image runs. */
static volatile int32_t given;

static int32_t hide(int32_t value)
{
    given = value;
    return given;
}

/* a * b / 2^shift, rounded down, modulo 2^32: made by division, not by shifts. */
static uint32_t divided(int32_t a, int32_t b, unsigned shift)
{
    const int64_t product = (int64_t)a * b, unit = (int64_t)1 << shift;
    return (uint32_t)((product / unit - (product % unit < 0)) & 0xffffffff);
}

static int32_t drawn(void)
{
    static uint32_t seed = 1;
    seed = seed * 1664525u + 1013904223u;
    return hide((int32_t)seed);
}

/* Would catch a lost carry between the parts of the 64-bit product, and a library routine for it that is wrong: of the
 * ends and of operands of every size. */
static void products_agree_with_division(void)
{
    static const int32_t corners[] = { 0,      1,         -1,        -3,    255,        32767,         -32768,    65535,
                                       -65536, INT32_MAX, INT32_MIN, 65537, 0x7fff8000, INT32_MIN + 1, 0x55555555 };
    const unsigned count = sizeof corners / sizeof corners[0];
    for (unsigned shift = 16; shift <= 31; shift++)
        for (unsigned i = 0; i < count * count + 100u; i++) {
            const int is_corner = i < count * count;
            const int32_t a = is_corner ? hide(corners[i % count]) : drawn() >> (i % 31u);
            const int32_t b = is_corner ? hide(corners[i / count]) : drawn() >> (i * 7u % 31u);
            TEST_ASSERT_EQUAL_HEX32(divided(a, b, shift), (uint32_t)labial_mulshift(a, b, shift));
        }
}

/* Would catch the same in the narrower products of the solver, whatever way this core takes. */
static void parts_agree_with_division(void)
{
    for (unsigned i = 0; i < 1000; i++) {
        const int32_t x = drawn() >> (i % 31u), f = i % 10u ? (drawn() & 0x1ffff) % 65537 : 65536;
        TEST_ASSERT_EQUAL_HEX32(divided(x, f, 16), (uint32_t)labial_part16(x, (uint32_t)f));
    }
}

/* Would catch a compiler whose right shifts of negative numbers are not arithmetic, or round towards zero. */
static void shifts_are_arithmetic(void)
{
    TEST_ASSERT_EQUAL_INT32(-1, hide(-1) >> 1);
    TEST_ASSERT_EQUAL_INT32(-1, hide(-1) >> 31);
    TEST_ASSERT_EQUAL_INT32(-3, hide(-5) >> 1);
    TEST_ASSERT_EQUAL_INT32(INT32_MIN / 65536, hide(INT32_MIN) >> 16);
}

/* Would catch a compiler that takes sums beyond 32 bits for impossible. */
static void sums_wrap(void)
{
    TEST_ASSERT_EQUAL_INT32(INT32_MIN, labial_add(hide(INT32_MAX), 1));
    TEST_ASSERT_EQUAL_INT32(INT32_MAX, labial_sub(hide(INT32_MIN), 1));
    TEST_ASSERT_EQUAL_INT32(-8, labial_sub(hide(-5), 3));
    TEST_ASSERT_EQUAL_INT32(127, labial_clamp(hide(INT32_MAX), 127));
    TEST_ASSERT_EQUAL_INT32(-127, labial_clamp(hide(INT32_MIN), 127));
    TEST_ASSERT_EQUAL_INT32(-126, labial_clamp(hide(-126), 127));
}

/* Would catch 16-bit promotions: products of uint16 that do not fit an int. */
static void costs_are_unsigned(void)
{
    TEST_ASSERT_EQUAL_INT32(0, labial_weight((uint8_t)hide(0)));
    TEST_ASSERT_EQUAL_INT32(15, labial_weight((uint8_t)hide(15)));
    TEST_ASSERT_EQUAL_INT32(16, labial_weight((uint8_t)hide(16)));
    TEST_ASSERT_EQUAL_INT32(507904, labial_weight((uint8_t)hide(255)));
    TEST_ASSERT_EQUAL_INT32(65535, labial_z((uint32_t)hide(65535), (uint16_t)hide(65535), 65535));
    TEST_ASSERT_EQUAL_INT32(16384, labial_z((uint32_t)hide(32768), (uint16_t)hide(2048), 65535));
    TEST_ASSERT_EQUAL_INT32(33553408, labial_z_cost((uint32_t)hide(65535)));
    TEST_ASSERT_EQUAL_INT32(1, labial_z_cost((uint32_t)hide(12)));
}

/* Would catch squares that overflow where an int is short, and a quotient that a library routine gets wrong. */
static void transitions_are_smooth(void)
{
    static const struct {
        uint16_t step, steps;
        int16_t gone; /* of 16384: 3 s^2 - 2 s^3, each product and quotient rounded down */
    } transitions[] = {
        { 0, 1, 0 },          { 1, 1, 16384 }, { 1, 2, 8192 },         { 1, 3, 4246 },          { 2, 3, 12133 },
        { 1, 9, 561 },        { 4, 9, 6829 },  { 8, 9, 15821 },        { 7, 20, 4613 },         { 499, 1000, 8166 },
        { 999, 1000, 16383 }, { 1, 65535, 0 }, { 32768, 65535, 8192 }, { 65534, 65535, 16383 }, { 65535, 65535, 16384 },
    };
    for (unsigned i = 0; i < sizeof transitions / sizeof transitions[0]; i++)
        TEST_ASSERT_EQUAL_INT32(transitions[i].gone,
                                labial_ease((unsigned)hide(transitions[i].step), (unsigned)hide(transitions[i].steps)));
}

void test_arithmetic(void)
{
    Unity.TestFile = __FILE__;
    RUN_TEST(shifts_are_arithmetic);
    RUN_TEST(sums_wrap);
    RUN_TEST(products_agree_with_division);
    RUN_TEST(parts_agree_with_division);
    RUN_TEST(costs_are_unsigned);
    RUN_TEST(transitions_are_smooth);
}
