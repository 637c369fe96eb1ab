/*
 * test_arithmetic.c - what the compiler and the processor make of lib/fixed.h and of the C that the library relies on.
 */
#include "device.h"

#include "fixed.h"

/* Exact results, from integers of any length: a * b / 2^shift, rounded down, modulo 2^32. */
static const struct {
    int32_t a, b;
    unsigned shift;
    int32_t result;
} products[] = {
    { 255, -1, 16, -1 },
    { -3, -1, 16, 0 },
    { 922121676, -2147483647, 16, -988137738 },
    { -32768, -2147483647, 16, 1073741823 },
    { -3, -1586449608, 16, 72621 },
    { -224588375, 2147483647, 17, 1131038385 },
    { -32768, 255, 17, -64 },
    { 255, -1842911656, 17, -3585377 },
    { -256, 32767, 17, -64 },
    { 2, -1636341327, 17, -24969 },
    { -2147483647, 1999744784, 23, -833556242 },
    { 1946412080, -32768, 23, -7603173 },
    { -1292809068, 351564607, 23, 1653247991 },
    { -2039265503, -65537, 23, 15932004 },
    { 1236683272, 314395342, 23, -895179149 },
    { -2147483647, -65537, 24, 8388735 },
    { 1431655765, 2, 24, 170 },
    { -1833839630, -780166454, 24, -622971024 },
    { 2147450880, -1804336357, 24, 976704382 },
    { 295334609, -237592874, 24, 112545221 },
    { 2, 65536, 30, 0 },
    { -29652725, 1914012528, 30, -52857853 },
    { 2147483647, 1490376253, 30, -1314214792 },
    { INT32_MIN, -3, 30, 6 },
    { 32767, 555512015, 30, 16952 },
    { 1708957520, 1431655765, 31, 1139305013 },
    { INT32_MIN, 65535, 31, -65535 },
    { -776187175, 65535, 31, -23687 },
    { -58123446, 2147483647, 31, -58123446 },
    { 648200381, 255, 31, 76 },
    { INT32_MIN, INT32_MIN, 31, INT32_MIN },
    { 2147483647, 2147483647, 31, 2147483646 },
    { INT32_MIN, 2147483647, 31, -2147483647 },
    { 1, 1, 16, 0 },
    { 1, 32768, 16, 0 },
    { -1, 32768, 16, -1 },
    { -1, 32769, 16, -1 },
    { 65535, 65537, 16, 65535 },
    { -65536, 65535, 16, -65535 },
    { -1, 1, 16, -1 },
    { -1, 1, 31, -1 },
    { -1, 65535, 16, -1 },
    { 65535, 32769, 16, 32768 },
    { -65536, 32768, 31, -1 },
};

/* Values that the compiler cannot compute with before the image runs. */
static volatile int32_t given;

static int32_t hide(int32_t value)
{
    given = value;
    return given;
}

/* Would catch a lost carry between the parts of the 64-bit product, and a library routine for it that is wrong. */
static void products_are_exact(void)
{
    for (unsigned i = 0; i < sizeof products / sizeof products[0]; i++) {
        const int32_t a = hide(products[i].a), b = hide(products[i].b);
        TEST_ASSERT_EQUAL_HEX32((uint32_t)products[i].result, (uint32_t)labial_mulshift(a, b, products[i].shift));
        TEST_ASSERT_EQUAL_HEX32((uint32_t)products[i].result, (uint32_t)labial_mulshift(b, a, products[i].shift));
    }
}

/* Would catch the same for operands of every size; the expected product is made by division, not by shifts. */
static void products_agree_with_division(void)
{
    uint32_t seed = 1;
    for (unsigned shift = 16; shift <= 31; shift++)
        for (unsigned i = 0; i < 100; i++) {
            const int64_t unit = (int64_t)1 << shift;
            seed = seed * 1664525u + 1013904223u;
            const int32_t a = hide((int32_t)seed) >> (i % 31u);
            seed = seed * 1664525u + 1013904223u;
            const int32_t b = hide((int32_t)seed) >> (i * 7u % 31u);
            const int64_t product = (int64_t)a * b;
            int64_t quotient = product / unit;
            if (product % unit < 0)
                quotient--;
            TEST_ASSERT_EQUAL_HEX32((uint32_t)(quotient & 0xffffffff), (uint32_t)labial_mulshift(a, b, shift));
        }
}

/* Would catch the same in the narrower products of the solver, whatever way this core takes. */
static void parts_agree_with_division(void)
{
    uint32_t seed = 1;
    for (unsigned i = 0; i < 1000; i++) {
        const int64_t unit = 65536;
        seed = seed * 1664525u + 1013904223u;
        const int32_t x = hide((int32_t)seed) >> (i % 31u);
        seed = seed * 1664525u + 1013904223u;
        const int32_t f = i % 10u ? hide((int32_t)(seed >> 15) % 65537) : 65536;
        const int64_t product = (int64_t)x * f;
        int64_t quotient = product / unit;
        if (product % unit < 0)
            quotient--;
        TEST_ASSERT_EQUAL_INT32((int32_t)quotient, labial_part16(x, (uint32_t)f));
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
    RUN_TEST(products_are_exact);
    RUN_TEST(products_agree_with_division);
    RUN_TEST(parts_agree_with_division);
    RUN_TEST(costs_are_unsigned);
    RUN_TEST(transitions_are_smooth);
}
