/*
 * test_shape.c - shape selection (equation 2 and its additions) and moving targets, against doubles; and FAP 17 of the
 * corners: the table of labial/model.h.
 *
 * The oracle takes costs as the tables state them, in whole units of 1/32 nat, so that what is compared is the choice
 * and the mixture, not the rounding of costs.
 */
#include "suite.h"
#include "channels.h"
#include "oracle.h"
#include "shape.h"
#include "units.h"

#define COMPONENTS LABIAL_PHONEME_COMPONENTS_MAX

static fixture_model_t f;
static labial_phoneme_t phonemes[FIXTURE_CLASSES]; /* one of each class, the first of which is selected */
static labial_component_t components[COMPONENTS];
static uint8_t contexts[COMPONENTS * FIXTURE_CLASSES];
static int8_t shapes[COMPONENTS * LABIAL_CHANNELS], slopes[COMPONENTS * LABIAL_CHANNELS];

/* One phoneme of `count` random components, with all optional tables. */
static void make(fixture_random_t *random, unsigned count)
{
    fixture_rich(&f);
    memset(phonemes, 0, sizeof phonemes);
    for (unsigned c = 0; c < FIXTURE_CLASSES; c++) {
        phonemes[c].component_count = (uint8_t)count;
        phonemes[c].viseme_class = (uint8_t)c;
    }
    for (unsigned c = 0; c < COMPONENTS; c++) {
        components[c].cost = (uint16_t)fixture_below(random, 80);
        components[c].duration_mean = (uint16_t)(40 + fixture_below(random, 300));
        components[c].duration_gain = (uint16_t)(262144.0 / ((15.0 + fixture_below(random, 100)) * sqrt(2.0)));
    }
    for (unsigned i = 0; i < sizeof contexts; i++)
        contexts[i] = (uint8_t)fixture_random(random);
    for (unsigned i = 0; i < sizeof shapes; i++) {
        shapes[i] = (int8_t)((int)fixture_below(random, 255) - 127);
        slopes[i] = (int8_t)((int)fixture_below(random, 255) - 127);
    }
    for (unsigned i = 0; i < LABIAL_CHANNELS; i++) {
        f.channels[i].shape_scale = (uint16_t)(1000 + fixture_below(random, 15000));
        f.channels[i].slope_scale = (uint16_t)fixture_below(random, 3000);
    }
    f.model.phoneme_count = FIXTURE_CLASSES;
    f.model.pair_count = 0;
    f.model.silence = 0;
    f.model.component_count = COMPONENTS;
    f.model.phonemes = phonemes;
    f.model.components = components;
    f.model.contexts = contexts;
    f.model.shapes = shapes;
    f.model.slopes = slopes;
    assert_ok(labial_model_check(&f.model));
}

/* (d - mu) / (sigma sqrt 2) */
static double deviation(unsigned c, unsigned ms)
{
    return ((double)ms - components[c].duration_mean) * components[c].duration_gain / 4096.0 / 64.0;
}

/* z, in 1/64, counts up to 65535: a thousand and more deviations. */
static double cost_of(unsigned c, unsigned ms, unsigned previous, unsigned next)
{
    const double exact = floor(fabs(deviation(c, ms)) * 64.0), z = exact < 65535.0 ? exact : 65535.0;
    double cost = components[c].cost + floor(z * z / 128.0);
    if (f.model.contexts)
        cost += 16.0 * (contexts[c * FIXTURE_CLASSES + previous] % 16 + contexts[c * FIXTURE_CLASSES + next] / 16);
    return cost;
}

/* The expected shape of one channel; z counts up to three standard deviations. */
static double oracle(const double *shares, unsigned count, unsigned ms, unsigned channel)
{
    const labial_channel_t *k = &f.channels[channel];
    const double most = 3.0 / sqrt(2.0);
    double sum = 0;
    for (unsigned c = 0; c < count; c++) {
        double z = deviation(c, ms);
        z = z > most ? most : z < -most ? -most : z;
        sum += shares[c] * shapes[c * LABIAL_CHANNELS + channel] * k->shape_scale / 256.0;
        if (f.model.slopes)
            sum += shares[c] * z * slopes[c * LABIAL_CHANNELS + channel] * k->slope_scale / 256.0;
    }
    return sum > LABIAL_POSITION_MAX ? LABIAL_POSITION_MAX : sum < -LABIAL_POSITION_MAX ? -LABIAL_POSITION_MAX : sum;
}

/* Rounding of z to 1/64 of a slope of 127 steps, and of shares to 1/4096 of shapes 254 steps apart. */
static double tolerance(unsigned channel, unsigned count)
{
    const labial_channel_t *k = &f.channels[channel];
    return 2.0 + (f.model.slopes ? 127.0 * k->slope_scale / 256.0 * (1.5 / 64.0 + count * 3.0 / 4096.0) : 0.0) +
           (f.model.mixture_mean ? count * 254.0 * k->shape_scale / 256.0 / 4096.0 * 1.5 : 0.0);
}

/* Compares one selection; `soft` as the model says. */
static void compare(unsigned count, unsigned ms, unsigned previous, unsigned next)
{
    labial_shape_t shape[LABIAL_CHANNELS];
    double costs[COMPONENTS], shares[COMPONENTS], sum = 0;
    unsigned best = 0;
    oracle_shape(&f.model, 0, (uint16_t)ms, previous, next, shape);
    for (unsigned c = 0; c < count; c++) {
        costs[c] = cost_of(c, ms, previous, next);
        best = costs[c] < costs[best] ? c : best; /* equation 2; the first of several that are alike */
    }
    const double least = costs[best];
    for (unsigned c = 0; c < count; c++) {
        shares[c] = f.model.mixture_mean ? exp((least - costs[c]) / 32.0) : c == best;
        sum += shares[c];
    }
    for (unsigned c = 0; c < count; c++)
        shares[c] /= sum;
    for (unsigned k = 0; k < LABIAL_CHANNELS; k++) {
        const double wanted = oracle(shares, count, ms, k);
        assert_near(shape[k].knots[0], wanted, tolerance(k, count));
        assert_int_equal(shape[k].knots[1], shape[k].knots[0]); /* no pair moves it */
    }
}

/* All combinations of what a model may have, on random tables and durations from none to beyond every component. */
TEST(selection_follows_the_formula)
{
    fixture_random_t random = { 31 };
    for (unsigned round = 0; round < FIXTURE_ROUNDS(4000); round++) {
        const unsigned count = 1 + round % COMPONENTS;
        make(&random, count);
        f.model.mixture_mean = (uint8_t)(round / 8 % 2);
        if (round / 16 % 2)
            f.model.contexts = NULL;
        if (round / 32 % 2)
            f.model.slopes = NULL;
        compare(count, fixture_below(&random, round % 5 ? 400 : 65536), fixture_below(&random, FIXTURE_CLASSES),
                fixture_below(&random, FIXTURE_CLASSES));
    }
}

/* Of the longest durations and the strangest tables: within the range of positions, up to its ends. */
TEST(extremes_stay_within_the_range)
{
    fixture_random_t random = { 33 };
    unsigned at_ends = 0;
    for (unsigned round = 0; round < FIXTURE_ROUNDS(600); round++) {
        labial_shape_t shape[LABIAL_CHANNELS];
        const unsigned count = 1 + round % COMPONENTS;
        make(&random, count);
        f.model.mixture_mean = (uint8_t)(round & 1);
        for (unsigned i = 0; i < LABIAL_CHANNELS; i++) {
            f.channels[i].shape_scale = 32767;
            f.channels[i].slope_scale = 16383;
        }
        for (unsigned i = 0; i < sizeof shapes; i++) {
            shapes[i] = (int8_t)(i % 2 ? -128 : 127);
            slopes[i] = (int8_t)(i % 2 ? -128 : 127);
        }
        for (unsigned i = 0; i < COMPONENTS; i++) {
            components[i].cost = (uint16_t)fixture_random(&random);
            components[i].duration_gain = (uint16_t)fixture_random(&random);
            components[i].duration_mean = (uint16_t)fixture_random(&random);
        }
        oracle_shape(&f.model, 0, (uint16_t)fixture_random(&random), 0, 1, shape);
        for (unsigned i = 0; i < 2 * LABIAL_CHANNELS; i++) {
            const int value = shape[i % LABIAL_CHANNELS].knots[i / LABIAL_CHANNELS];
            assert_in_range(value + LABIAL_POSITION_MAX, 0, 2 * LABIAL_POSITION_MAX);
            at_ends |= value == LABIAL_POSITION_MAX ? 1u : value == -LABIAL_POSITION_MAX ? 2u : 0u;
        }
    }
    assert_int_equal(at_ends, 3);
}

static double limited(double value)
{
    return value > LABIAL_POSITION_MAX    ? LABIAL_POSITION_MAX
           : value < -LABIAL_POSITION_MAX ? -LABIAL_POSITION_MAX
                                          : value;
}

/* The shape between its knots plus, for every tap i, the curve of the phoneme at (i - behind) * stride, and not below the
 * floor of the frame's own phoneme: would catch taps in the wrong order, a wrong row of either table, a missing limit.
 * Nothing is contact here; test_contact.c is about that. */
TEST(targets_are_shapes_kernels_and_floors)
{
    enum { ROWS = FIXTURE_SPEECH_COUNT * LABIAL_KERNEL_TAPS_MAX };
    static int8_t kernels[ROWS * LABIAL_CHANNELS];
    static uint32_t words[ROWS * FIXTURE_KERNEL_WORDS];
    fixture_random_t random = { 34 };
    unsigned raised = 0, at_ends = 0;
    fixture_rich(&f);
    memset(f.contacts, 0, sizeof f.contacts);
    for (unsigned round = 0; round < FIXTURE_ROUNDS(2000); round++) {
        uint8_t labels[2 * LABIAL_REACH + 1];
        int16_t target[LABIAL_CHANNELS];
        labial_shape_t shape[LABIAL_CHANNELS];
        labial_taken_t taken = { 0 };
        const unsigned taps = fixture_below(&random, LABIAL_KERNEL_TAPS_MAX + 1);
        const unsigned channels = 1 + round % LABIAL_CHANNELS;
        taken.labels = labels + LABIAL_REACH;
        taken.share = (uint16_t)fixture_below(&random, 16385);
        taken.is_open = (uint8_t)fixture_below(&random, 2); /* of a phoneme without contact: nothing */
        f.model.kernels = words;
        f.model.channel_count = (uint8_t)channels;
        for (unsigned k = 0; k < LABIAL_CHANNELS; k++)
            f.model.sources[k] = (uint8_t)(k % channels);
        f.model.kernel_taps = (uint8_t)taps;
        f.model.kernel_behind = (uint8_t)(taps ? fixture_below(&random, taps) : 0);
        f.model.kernel_stride = (uint8_t)(1 + fixture_below(&random, 20));
        if (labial_model_check(&f.model) != LABIAL_OK)
            f.model.kernel_taps = f.model.kernel_behind = 0;
        for (unsigned i = 0; i < sizeof kernels; i++)
            kernels[i] = (int8_t)(round % 3 ? (int)fixture_random(&random) : round % 2 ? -128 : 127);
        fixture_pack_kernels(kernels, ROWS, channels, words);
        for (unsigned i = 0; i < sizeof labels; i++)
            labels[i] = (uint8_t)fixture_below(&random, FIXTURE_SPEECH_COUNT);
        for (unsigned k = 0; k < LABIAL_CHANNELS; k++) {
            for (unsigned i = 0; i < 2; i++)
                shape[k].knots[i] =
                    (int16_t)((int)fixture_below(&random, 2 * LABIAL_POSITION_MAX + 1) - LABIAL_POSITION_MAX);
            f.channels[k].kernel_scale = (uint16_t)(fixture_random(&random) >> (16 + k));
        }
        assert_int_equal(labial_shape_target(&f.model, shape, &taken, target), 0);
        for (unsigned k = 0; k < channels; k++) {
            const double start = shape[k].knots[0], end = shape[k].knots[1];
            double sum = 0;
            for (unsigned i = 0; i < f.model.kernel_taps; i++) {
                const int at = LABIAL_REACH + ((int)i - f.model.kernel_behind) * f.model.kernel_stride;
                sum += kernels[(labels[at] * (size_t)f.model.kernel_taps + i) * channels + k];
            }
            double wanted =
                limited(start + (end - start) * taken.share / 16384.0 + sum * f.channels[k].kernel_scale / 256.0);
            if (f.phonemes[labels[LABIAL_REACH]].floor) {
                const int least = f.floors[(f.phonemes[labels[LABIAL_REACH]].floor - 1u) * channels + k];
                raised += wanted < least;
                wanted = wanted < least ? least : wanted;
            }
            at_ends |= target[k] == LABIAL_POSITION_MAX ? 1u : target[k] == -LABIAL_POSITION_MAX ? 2u : 0u;
            assert_near(target[k], wanted, 1.01); /* two roundings */
        }
    }
    assert_true(raised > FIXTURE_ROUNDS(500)); /* floors were met */
    assert_int_equal(at_ends, 3);              /* and both ends of the range */
}

/* What a neighbour adds to a knot on channel k; `side` is 128 for the next one. */
static double pair_of(unsigned number, unsigned neighbour, unsigned side, unsigned knot, unsigned k)
{
    const unsigned knots = f.model.pair_knots, row = knots > 1 ? knot : 0;
    for (unsigned i = 0; i < FIXTURE_PAIRS; i++)
        if (f.pair_keys[i] == number * 256u + side + neighbour)
            return f.pairs[(i * knots + row) * LABIAL_CHANNELS + k] * f.channels[k].pair_scale / 256.0;
    return 0.0;
}

/* One phoneme between two neighbours; returns on how many channels both of these add something. */
static unsigned compare_pairs(unsigned number, unsigned previous, unsigned next)
{
    labial_shape_t without[LABIAL_CHANNELS], shape[LABIAL_CHANNELS];
    unsigned added = 0;
    f.model.pair_count = 0;
    oracle_shape(&f.model, number, 100, previous, next, without);
    f.model.pair_count = FIXTURE_PAIRS;
    oracle_shape(&f.model, number, 100, previous, next, shape);
    for (unsigned j = 0; j < 2; j++)
        for (unsigned k = 0; k < LABIAL_CHANNELS; k++) {
            const double before = pair_of(number, previous, 0, j, k), behind = pair_of(number, next, 128, j, k);
            const double wanted = limited(limited(without[k].knots[j] + before) + behind);
            added += before != 0.0 && behind != 0.0;
            assert_near(shape[k].knots[j], wanted, 1.02);
        }
    return added;
}

/* Every known pair adds its own row, every other nothing: would catch a search that misses the first, the last or the
 * middle row, a side or a phoneme taken for another, a row of one knot taken for two, the kernels' scale, a missing
 * limit. */
TEST(pairs_add_their_row_and_others_nothing)
{
    static labial_phoneme_t many[LABIAL_PHONEMES_MAX];
    fixture_random_t random = { 35 };
    unsigned added = 0;
    fixture_rich(&f);
    for (unsigned k = 0; k < LABIAL_CHANNELS; k++)
        f.channels[k].pair_scale = (uint16_t)(fixture_random(&random) >> (16 + k));
    for (unsigned k = 0; k < LABIAL_PHONEMES_MAX; k++)
        many[k] = f.phonemes[k % FIXTURE_SPEECH_COUNT];
    f.model.phonemes = many;
    f.model.phoneme_count = LABIAL_PHONEMES_MAX;
    for (unsigned number = 0; number < LABIAL_PHONEMES_MAX; number++) {
        for (unsigned round = 0; round < 2 * LABIAL_PHONEMES_MAX; round++) {
            /* each neighbour to either side, the other one any */
            const unsigned any = fixture_below(&random, round % 3 ? 8 : LABIAL_PHONEMES_MAX);
            f.model.pair_knots = (uint8_t)(1 + round / 2 % 2);
            added += compare_pairs(number, round % 2 ? round / 2 : any, round % 2 ? any : round / 2);
        }
    }
    assert_true(added > 100);
}

/* ---- FAP 17 ------------------------------------------------------------------------------------------------------ */

static labial_protrusion_t table;

static void fill(uint32_t seed, int16_t low, uint16_t gain, uint32_t range)
{
    fixture_random_t random = { fixture_seed(seed) };
    table.low = low;
    table.gain = gain;
    for (unsigned i = 0; i < LABIAL_PROTRUSION_VALUES; i++)
        table.values[i] = (int16_t)((int)fixture_below(&random, 2 * range) - (int)range);
}

/* Every sum of two corners there is, with tables of every width and place: would catch a product that overflows, a value
 * beyond the table, an interval that is off by one, rounding that is not to the nearest. */
TEST(tables_are_interpolated)
{
    static const int16_t lows[] = { -32768, -32767, -800, 0, 5, 32767 };
    static const uint16_t gains[] = { 0, 1, 127, 128, 700, 4096, 65535 };
    for (unsigned l = 0; l < COUNT_OF(lows); l++)
        for (unsigned g = 0; g < COUNT_OF(gains); g++) {
            fill(l * 16 + g + 1, lows[l], gains[g], g % 2 ? 32767 : 600);
            for (int32_t sum = 2 * INT16_MIN; sum <= 2 * INT16_MAX; sum += g % 2 ? 1 : 7) {
                const int32_t above = sum - 2 * lows[l];
                const double place = above < 0 ? 0 : above > 65535 ? 65535 : above;
                const double at = floor(place * gains[g] / 4096) / 256;
                const int i = at >= 16 ? 15 : (int)at;
                const double share = at >= 16 ? 1 : at - i;
                const double wanted = table.values[i] + share * (table.values[i + 1] - table.values[i]);
                assert_near(labial_protrusion(&table, sum), wanted, 0.5);
            }
        }
}

SUITE(NULL, NULL)
