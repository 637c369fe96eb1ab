/*
 * fixture.c - models made by hand, streams of phonemes and copies of input for the tests.
 */
#include "fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

uint32_t fixture_random(fixture_random_t *random)
{
    uint32_t x = random->state ? random->state : 0x9e3779b9u;
    x ^= x << 13;
    x ^= x >> 17;
    x ^= x << 5;
    random->state = x;
    return x * 0x2545f491u;
}

uint32_t fixture_below(fixture_random_t *random, uint32_t limit)
{
    return (uint32_t)(((uint64_t)fixture_random(random) * limit) >> 32);
}

/* ---- Models ---- */

double fixture_weight_value(uint8_t code)
{
    const unsigned exponent = (unsigned)code >> 4, mantissa = (unsigned)code & 15u;
    return exponent == 0 ? (double)mantissa : (double)((16ul + mantissa) << (exponent - 1u));
}

/* The code whose value is nearest to one, the lowest of several. */
static uint8_t nearest_code(double (*value_of)(uint8_t code), double value)
{
    unsigned best = 0;
    for (unsigned code = 1; code < 256; code++)
        if (fabs(value_of((uint8_t)code) - value) < fabs(value_of((uint8_t)best) - value))
            best = code;
    return (uint8_t)best;
}

/* The nearest weight. */
static uint8_t weight_code(double value)
{
    return nearest_code(fixture_weight_value, value);
}

/* Steps of a component's shape; 127 steps are 300 FAP units. */
static int shape_steps(unsigned phoneme, unsigned component, unsigned channel)
{
    const int steps = (int)((phoneme * 37u + channel * 53u + phoneme * channel * 11u) % 41u) * 5 - 100;
    return (phoneme == FIXTURE_SIL ? steps / 10 : steps) + (int)component * 12;
}

#define SHAPE_SCALE 9675u /* Q8 positions per step: 127 steps are 4,800 positions */

static int position_of_steps(int steps)
{
    return (int)((double)steps * SHAPE_SCALE / 256.0 + (steps < 0 ? -0.5 : 0.5));
}

static int centre_of(unsigned channel)
{
    return ((int)channel - 6) * 40;
}

/* Every state is entered from itself and from those up to `reach` away, 1 or 3; those at the ends have fewer. */
static void connect(fixture_model_t *f, unsigned c, unsigned count, unsigned reach)
{
    const unsigned predecessors = 2 * reach + 2; /* 4 or 8: one at least is repeated */
    for (unsigned q = 0; q < count; q++) {
        labial_transition_t *transitions = f->transitions[c] + q * predecessors;
        unsigned n = 0;
        for (unsigned p = 0; p < count; p++) {
            const unsigned away = p > q ? p - q : q - p;
            const unsigned cost = away == 0 ? 4 : away == 1 ? 60 : 90;
            if (away <= reach)
                transitions[n++] = (labial_transition_t){ (uint8_t)p, (uint8_t)cost };
        }
        for (; n < predecessors; n++)
            transitions[n] = transitions[n - 1];
    }
    f->model.predecessor_fours = (uint8_t)(predecessors / 4);
}

static int in_order(const void *a, const void *b)
{
    return *(const int *)a - *(const int *)b;
}

double fixture_gain_value(uint8_t code)
{
    return ldexp(16 + code % 16, 12 - code / 16);
}

uint8_t fixture_gain_code(double sigma)
{
    return nearest_code(fixture_gain_value, 262144.0 / (sigma * 1.41421356237));
}

double fixture_motion(const labial_channel_t *channel, const labial_state_t *state, unsigned which, int32_t gain)
{
    const int32_t scaled = state->motion[which] * (channel->motion_scale[which] * gain / 256) + 128;
    return scaled >= 0 ? scaled / 256 : -((255 - scaled) / 256); /* rounded down */
}

void fixture_pack_kernels(const int8_t *steps, size_t rows, unsigned channels, uint32_t *kernels)
{
    for (; rows > 0; rows--, steps += channels, kernels += LABIAL_KERNEL_WORDS(channels)) {
        memset(kernels, 0x5a, LABIAL_KERNEL_WORDS(channels) * sizeof *kernels); /* of what nobody asks for */
        for (unsigned k = 0; k < channels; k++) {
            kernels[k / 4] &= ~((uint32_t)0xff << k % 4 * 8);
            kernels[k / 4] |= (uint32_t)(steps[k] + 128) << k % 4 * 8;
        }
    }
}

int fixture_kernel(const uint32_t *kernels, size_t row, unsigned channels, unsigned channel)
{
    return (int)(kernels[row * LABIAL_KERNEL_WORDS(channels) + channel / 4] >> channel % 4 * 8 & 255u) - 128;
}

/* gain = 2^18 / (sigma * sqrt 2) */
static uint16_t gain_of(double sigma)
{
    return (uint16_t)(262144.0 / (sigma * 1.41421356237) + 0.5);
}

/* Tables that all fixtures share; `count` phonemes of two components each. */
static void build(fixture_model_t *f, unsigned count, unsigned states, unsigned silence, unsigned reach)
{
    int means[LABIAL_STATES_MAX];
    memset(f, 0, sizeof *f);
    f->model.format = LABIAL_MODEL_FORMAT;
    f->model.frames_per_second = FIXTURE_RATE;
    f->model.component_count = (uint16_t)(2 * count);
    f->model.phoneme_count = (uint8_t)count;
    f->model.class_count = FIXTURE_CLASSES;
    f->model.state_count = (uint8_t)states;
    f->model.search_stride = 1;
    f->model.pair_knots = 1;
    f->model.silence = (uint8_t)silence;
    f->model.channel_count = LABIAL_CHANNELS;
    for (unsigned k = 0; k < LABIAL_CHANNELS; k++)
        f->model.sources[k] = (uint8_t)k;
    f->model.phonemes = f->phonemes;
    f->model.components = f->components;
    f->model.shapes = f->shapes;
    f->model.channels = f->channels;
    for (unsigned p = 0; p < count; p++) {
        f->phonemes[p].first_component = (uint16_t)(2 * p);
        f->phonemes[p].component_count = 2;
        f->phonemes[p].viseme_class = (uint8_t)(p % FIXTURE_CLASSES);
        for (unsigned k = 0; k < 2; k++) {
            labial_component_t *component = &f->components[2 * p + k];
            component->cost = (uint16_t)(k * 10);
            component->duration_mean = (uint16_t)(k ? 260 : 100);
            component->duration_gain = gain_of(k ? 70 : 40);
            for (unsigned c = 0; c < LABIAL_CHANNELS; c++)
                f->shapes[(2 * p + k) * LABIAL_CHANNELS + c] = (int8_t)shape_steps(p, k, c);
        }
    }
    for (unsigned c = 0; c < LABIAL_CHANNELS; c++) {
        labial_channel_t *channel = &f->channels[c];
        channel->centre = (int16_t)centre_of(c);
        channel->shape_scale = SHAPE_SCALE;
        channel->slope_scale = 256;
        channel->kernel_scale = 256;
        channel->pair_scale = 256;
        channel->emissions = f->emissions[c];
        channel->states = f->states[c];
        channel->transitions = f->transitions[c];
        channel->initials = f->initials[c];
        channel->motion_scale[0] = channel->motion_scale[1] = 256;
        /* The shapes of the phonemes, and the rest spread over +-300 FAP units. */
        for (unsigned q = 0; q < states; q++)
            means[q] = q < count ? position_of_steps(shape_steps(q, 0, c))
                                 : -4800 + (int)(9600u * (q - count) / (states > count + 1 ? states - count - 1 : 1));
        qsort(means, states, sizeof *means, in_order);
        for (unsigned q = 0; q < states; q++) {
            labial_emission_t *emission = &f->emissions[c][q];
            labial_state_t *state = &f->states[c][q];
            emission->mean = (int16_t)means[q];
            emission->gain = fixture_gain_code(240.0); /* 15 FAP units; the nearest state is the likeliest */
            f->initials[c][q] = (uint8_t)(60 + q % 5);
            state->mean = (int16_t)means[q];
            state->hold = weight_code(64);
            state->weight[0] = weight_code(90);
            state->weight[1] = weight_code(200);
        }
        connect(f, c, states, reach);
    }
}

static void make_speech(fixture_model_t *f, unsigned states)
{
    build(f, FIXTURE_SPEECH_COUNT, states, FIXTURE_SIL, FIXTURE_PREDECESSORS / 2 - 1);
    f->phonemes[FIXTURE_A].boundary = 1;
    f->phonemes[FIXTURE_O].boundary = 1;
    f->phonemes[FIXTURE_P].boundary = 1;
}

/* Kernels of so many taps, `behind` of them before the frame, unless the library has no room for any. */
static void reach(fixture_model_t *f, unsigned taps, unsigned behind, unsigned stride)
{
    f->model.kernel_taps = (uint8_t)(stride ? taps : 0);
    f->model.kernel_behind = (uint8_t)(stride ? behind : 0);
    f->model.kernel_stride = (uint8_t)stride;
}

/* Floors and contacts, unless the library has no room for the frames that short contacts borrow. Row r has floors on the
 * channels of which r + c is a multiple of three. */
static void add_floors(fixture_model_t *f)
{
    if (LABIAL_REACH + 0 < LABIAL_CONTACT_FRAMES)
        return;
    f->model.floor_count = FIXTURE_FLOORS;
    f->model.floors = f->floors;
    f->model.contacts = f->contacts;
    f->phonemes[FIXTURE_P].floor = 1;
    f->phonemes[FIXTURE_O].floor = 2;
    f->phonemes[FIXTURE_S].floor = 3;
    f->phonemes[FIXTURE_SIL].floor = 4;
    f->contacts[0] = 1u << 0 | 1u << 3 | 1u << 12 | 1u << 4; /* with 6 and 9 plain; 4 has no floor, but is held */
    f->contacts[2] = 1u << 1 | 1u << 4;
    f->contacts[3] = 1u << 0 | 1u << 3 | 1u << 6 | 1u << 9;
}

/* All that goes beyond the published method. */
static void enrich(fixture_model_t *f)
{
    fixture_random_t random = { 7 };
    int8_t kernels[FIXTURE_PHONEMES * FIXTURE_TAPS * LABIAL_CHANNELS];
    f->model.mixture_mean = 1;
    f->model.search_stride = FIXTURE_STRIDE;
    reach(f, FIXTURE_TAPS, 4, LABIAL_REACH / 4 < 3 ? LABIAL_REACH / 4 : 3);
    f->model.contexts = f->contexts;
    f->model.slopes = f->slopes;
    f->model.kernels = f->kernels;
    f->model.pair_count = FIXTURE_PAIRS;
    f->model.pair_keys = f->pair_keys;
    f->model.pairs = f->pairs;
    for (unsigned i = 0; i < FIXTURE_PAIRS; i++) /* every phoneme, both sides; every second neighbour */
        f->pair_keys[i] = (uint16_t)(i / (2 * FIXTURE_PAIR_SIDE) << 8 | (i / FIXTURE_PAIR_SIDE % 2) * 128 |
                                     i % FIXTURE_PAIR_SIDE * 2);
    f->model.pair_knots = 2;
    for (unsigned i = 0; i < sizeof f->pairs; i++)
        f->pairs[i] = (int8_t)((int)fixture_below(&random, 81) - 40);
    for (unsigned i = 0; i < FIXTURE_FLOORS * LABIAL_CHANNELS; i++)
        f->floors[i] = (int16_t)(i % 3 ? LABIAL_NO_FLOOR : (int)fixture_below(&random, 4000) - 2000);
    add_floors(f);
    for (unsigned i = 0; i < sizeof f->contexts; i++)
        f->contexts[i] = (uint8_t)(fixture_below(&random, 6) | fixture_below(&random, 6) << 4); /* below 3 nats */
    for (unsigned i = 0; i < sizeof f->slopes; i++)
        f->slopes[i] = (int8_t)((int)fixture_below(&random, 81) - 40);
    for (unsigned i = 0; i < sizeof kernels; i++)
        kernels[i] = (int8_t)((int)fixture_below(&random, 201) - 100);
    fixture_pack_kernels(kernels, FIXTURE_PHONEMES * FIXTURE_TAPS, LABIAL_CHANNELS, f->kernels);
    for (unsigned c = 0; c < LABIAL_CHANNELS; c++) {
        f->channels[c].contact_weight = weight_code(1500);
        f->channels[c].slope_scale = 2048; /* 40 steps: 20 FAP units per unit of z */
        f->channels[c].kernel_scale = 512; /* 100 steps: 12.5 FAP units */
        f->channels[c].pair_scale = 1280;  /* 40 steps: 12.5 FAP units */
        for (unsigned q = 0; q < f->model.state_count; q++) {
            labial_state_t *state = &f->states[c][q];
            f->emissions[c][q].gain = fixture_gain_code(400.0 + 40.0 * (double)(q % 3));
            f->emissions[c][q].cost = (uint8_t)(q % 3 * 3);
            state->motion[0] = (int8_t)((int)fixture_below(&random, 161) - 80);
            state->motion[1] = (int8_t)((int)fixture_below(&random, 41) - 20);
            state->hold = weight_code(120.0 + (double)fixture_below(&random, 400));
            state->share = (uint8_t)(160 + fixture_below(&random, 90));
        }
    }
}

void fixture_plain(fixture_model_t *fixture)
{
    make_speech(fixture, FIXTURE_SPEECH_STATES);
}

void fixture_rich(fixture_model_t *fixture)
{
    fixture_plain(fixture);
    enrich(fixture);
}

void fixture_slow(fixture_model_t *fixture)
{
    make_speech(fixture, LABIAL_STATES_MAX);
    enrich(fixture);
    fixture->model.search_stride = 3;
    reach(fixture, 5, 2, LABIAL_REACH / 2);
}

void fixture_laughter(fixture_model_t *fixture)
{
    build(fixture, FIXTURE_LAUGH_COUNT, FIXTURE_LAUGH_STATES, FIXTURE_LAUGH_SIL, 1);
    fixture->model.search_stride = FIXTURE_STRIDE;
    fixture->phonemes[FIXTURE_HA].boundary = 1;
    for (unsigned i = 0; i < LABIAL_CHANNELS; i++) /* silence near neutral, as that of the speech models */
        fixture->shapes[2 * FIXTURE_LAUGH_SIL * LABIAL_CHANNELS + i] = 5;
}

const uint8_t fixture_computed[LABIAL_CHANNELS] = { 0, 1, LABIAL_FROM_CORNERS, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12 };
const uint8_t fixture_mirrored[LABIAL_CHANNELS] = { 0, 1, LABIAL_FROM_CORNERS, 3, 4, 5, 5, 7, 7, 9, 9, 11, 11 };
const uint8_t fixture_crossed[LABIAL_CHANNELS] = { 0, 0, LABIAL_FROM_CORNERS, 3, 4, 6, 6, 8, 8, 9, 10, 12, 12 };

/* Moves the values of a table's rows that belong to channels that stay. */
#define NARROW(table, rows)                                                                                            \
    for (size_t row = 0; row < (rows); row++)                                                                          \
        for (unsigned k = 0; k < count; k++)                                                                           \
            (table)[row * count + k] = (table)[row * LABIAL_CHANNELS + own[k]];

void fixture_narrow(fixture_model_t *f, const uint8_t sources[LABIAL_CHANNELS])
{
    unsigned own[LABIAL_CHANNELS], column[LABIAL_CHANNELS], count = 0;
    int8_t steps[FIXTURE_PHONEMES * FIXTURE_TAPS * LABIAL_CHANNELS];
    const unsigned rows = f->model.phoneme_count * (unsigned)f->model.kernel_taps;
    for (unsigned k = 0; k < LABIAL_CHANNELS; k++) {
        column[k] = count;
        if (sources[k] == k)
            own[count++] = k;
    }
    for (unsigned i = 0; i < rows * LABIAL_CHANNELS; i++)
        steps[i] = (int8_t)fixture_kernel(f->kernels, i / LABIAL_CHANNELS, LABIAL_CHANNELS, i % LABIAL_CHANNELS);
    NARROW(steps, rows)
    fixture_pack_kernels(steps, rows, count, f->kernels);
    NARROW(f->shapes, FIXTURE_COMPONENTS)
    NARROW(f->slopes, FIXTURE_COMPONENTS)
    NARROW(f->pairs, FIXTURE_PAIRS * 2u)
    NARROW(f->floors, FIXTURE_FLOORS)
    for (unsigned i = 0; i < FIXTURE_FLOORS; i++) {
        unsigned bits = 0;
        for (unsigned k = 0; k < count; k++)
            bits |= ((unsigned)f->contacts[i] >> own[k] & 1u) << k;
        f->contacts[i] = (uint16_t)bits;
    }
    for (unsigned k = 0; k < count; k++)
        f->channels[k] = f->channels[own[k]];
    for (unsigned k = count; k < LABIAL_CHANNELS; k++)
        memset(&f->channels[k], 0, sizeof f->channels[k]);
    f->model.channel_count = (uint8_t)count;
    for (unsigned k = 0; k < LABIAL_CHANNELS; k++)
        f->model.sources[k] = sources[k] < LABIAL_CHANNELS ? (uint8_t)column[sources[k]] : sources[k];
    if (sources[2] != LABIAL_FROM_CORNERS)
        return;
    f->model.protrusion = &f->protrusion;
    f->protrusion.low = -1593;
    f->protrusion.gain = 2621; /* 16 intervals of 200 Q4 */
    for (unsigned i = 0; i < LABIAL_PROTRUSION_VALUES; i++)
        f->protrusion.values[i] = (int16_t)(i * (i % 3) * 6 + (i % 2) * 25);
}

void fixture_all(fixture_model_t *plain, fixture_model_t *rich, fixture_model_t *laugh, fixture_model_t *slow)
{
    fixture_plain(plain);
    fixture_rich(rich);
    fixture_laughter(laugh);
    fixture_slow(slow);
}

/* ---- Streams of phonemes ---- */

void fixture_stream(fixture_phoneme_t *out, size_t count, fixture_kind_t kind, uint32_t seed)
{
    fixture_random_t random = { fixture_seed(seed) * 2654435761u + (uint32_t)kind + 1u };
    for (size_t i = 0; i < count; i++) {
        fixture_phoneme_t *p = &out[i];
        p->model = 0;
        p->phoneme = (uint8_t)fixture_below(&random, FIXTURE_SPEECH_COUNT);
        p->ms = 40 + fixture_below(&random, 160);
        switch (kind) {
        case FIXTURE_ONE_FRAME:
            p->ms = 1000 / FIXTURE_RATE;
            break;
        case FIXTURE_PAUSES:
            if (i % 4 == 0) {
                p->phoneme = FIXTURE_SIL;
                p->ms = 900 + fixture_below(&random, 6000);
            }
            break;
        case FIXTURE_VOWELS:
            p->phoneme = (uint8_t)(FIXTURE_A + fixture_below(&random, 2));
            break;
        case FIXTURE_CONSONANTS:
            p->phoneme = (uint8_t)(FIXTURE_S + fixture_below(&random, 2));
            break;
        case FIXTURE_CONTACTS:
            p->ms = fixture_below(&random, 5) * (1000 / FIXTURE_RATE);
            if (fixture_below(&random, 2))
                p->phoneme = (uint8_t)(FIXTURE_P + fixture_below(&random, 2));
            if (fixture_below(&random, 8) == 0)
                p->ms = fixture_below(&random, 46) * (1000 / FIXTURE_RATE);
            break;
        case FIXTURE_RANDOM:
        case FIXTURE_LONG:
            p->ms = fixture_below(&random, 401);
            break;
        case FIXTURE_MILLI:
        case FIXTURE_ZERO:
            p->ms = kind == FIXTURE_MILLI;
            break;
        case FIXTURE_HOUR:
            p->ms = i == 0 ? LABIAL_DURATION_MAX : p->ms;
            break;
        case FIXTURE_KINDS:
            break;
        }
    }
}

uint64_t fixture_duration(const fixture_phoneme_t *input, size_t count)
{
    uint64_t sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += input[i].ms;
    return sum;
}

int fixture_is_exact(uint64_t frames, uint64_t ms, unsigned rate)
{
    const uint64_t wanted = ms * rate, got = frames * 1000u;
    return (wanted > got ? wanted - got : got - wanted) <= 500u;
}

/* ---- Rigs in doubles ---- */

labial_rig_output_t fixture_jaw(int32_t maximum, int32_t slew, int32_t acceleration)
{
    const labial_rig_output_t output = { .weights = { [4] = -LABIAL_RIG_ONE }, /* FAP 52 */
                                         .contact = 1,
                                         .gain = LABIAL_RIG_GAIN(1, 1),
                                         .neutral = 1400,
                                         .minimum = 1400,
                                         .maximum = maximum,
                                         .slew = slew,
                                         .closed = 1400,
                                         .acceleration = acceleration };
    return output;
}

double fixture_limited(double value, double low, double high)
{
    return value < low ? low : value > high ? high : value;
}

double fixture_rest(const labial_rig_output_t *output)
{
    return fixture_limited(output->contact ? output->closed : output->neutral, output->minimum, output->maximum);
}

double fixture_output(const labial_rig_output_t *output, const int16_t faps[LABIAL_CHANNELS], const uint8_t *shares)
{
    const double opening = -(double)faps[3] - faps[4]; /* FAPs 51 and 52 */
    double move = 0, sounds = 0;
    for (unsigned i = 0; i < LABIAL_CHANNELS; i++)
        move += (double)output->weights[i] / 4096.0 * faps[i];
    move = floor(move * output->gain / 65536.0 + 0.5);
    for (unsigned i = 0; i < LABIAL_VISEMES && shares && output->visemes; i++)
        sounds += output->visemes[i] * (double)shares[i] / LABIAL_VISEME_ONE;
    double value = output->neutral + (output->invert ? -move : move) + floor(sounds + 0.5);
    value = fixture_limited(value, output->minimum, output->maximum);
    if (output->contact)
        value = floor(value + (output->closed - value) * fixture_limited((136.0 - opening) / 64.0, 0, 1) + .5);
    return value;
}

void *fixture_room(size_t count, size_t size)
{
    void *room = calloc(count ? count : 1u, size ? size : 1u);
    if (!room)
        abort();
    return room;
}

void *fixture_copy(const void *bytes, size_t size)
{
    return memcpy(fixture_room(size, 1), bytes, size);
}

int fixture_find(const labial_names_t *names, const char *name, size_t length)
{
    char *copy = (char *)fixture_copy(name, length);
    const int result = labial_find(names, copy, length);
    free(copy);
    return result;
}
