/*
 * hear_features.c - sound to features, as export/labial/hearing/features.py describes; the tables are written from
 * there. hearing/integer.py computes the same integers.
 *
 *     256 samples --middle, scale, Hann--> 128 pairs --transform--> bins --shares--> 24 bands --log2, level--> features
 *
 * The samples of a window take 14 bits, whatever their level. A constant that is taken off them changes no bin of a
 * band: the Hann window has no share of it beyond the bin of 62.5 Hz. The transform divides by its number of points, so
 * that no modulus grows: 2^14 sqrt 2 for a sample pair is its bound throughout.
 *
 * The window's samples, its spectrum and what layers of the network put out share their memory, since each is done with
 * before the next one begins; only the samples that the next window needs are kept aside.
 */
#include "hear_parts.h"

#include <string.h>

#include "fixed.h"
#include "hear_features_table.h"

#define PAIRS (LABIAL_HEAR_WINDOW_ / 2)

/* Sound that stays within this span for a frame is silent. */
#define SILENT_SPAN 32

/* Bins from FIRST_BIN to LAST_BIN belong to bands. */
#define FIRST_BIN 2u
#define LAST_BIN 121u

/* log2 in Q8 of the least energy; a level's fall in a hop, and until a hop has reached it; log2 in Q8 of a feature's
 * range around the level. */
#define LOG_LEAST 256
#define LEVEL_LEAST (LABIAL_HEAR_LEVEL_MIN / 256 * LABIAL_HEAR_LEVEL_ONE)
#define LEVEL_FALL 3146
#define LEVEL_SEARCH 11796
#define FEATURE_LEAST (-12 * 256)
#define FEATURE_MOST (8 * 256)
#define FEATURE_OFFSET (3 * 256)

static int32_t cosine(unsigned turn)
{
    return sine[(turn + 64u) & 255u];
}

/* How many bits a number has. */
static unsigned bits_of(uint32_t value)
{
    unsigned bits = 0;
    for (; value >= 256u; value >>= 8)
        bits += 8u;
    for (; value > 0u; value >>= 1)
        bits++;
    return bits;
}

/* log2 in Q8, of numbers above 0. */
static int32_t log2_q8(uint32_t value)
{
    const unsigned bits = bits_of(value);
    const uint32_t top = bits > 16u ? value >> (bits - 16u) : value << (16u - bits); /* 2^15 .. 2^16 - 1 */
    const int16_t *at = logarithms + (top >> 10 & 31u);
    return ((int32_t)bits - 1) * 256 + at[0] + (((at[1] - at[0]) * (int32_t)(top & 1023u)) >> 10);
}

/* Makes 14 bits of the samples and shapes them by the window. Returns by how many bits they grew, -1 .. 13; or 16 for a
 * constant, and then leaves them. */
static int shape_window(int16_t window[LABIAL_HEAR_WINDOW_])
{
    int32_t low = window[0], high = window[0], middle, value;
    unsigned i;
    int up;
    for (i = 1; i < LABIAL_HEAR_WINDOW_; i++) {
        if (window[i] < low)
            low = window[i];
        else if (window[i] > high)
            high = window[i];
    }
    if (low == high)
        return 16;
    middle = (low + high) >> 1;
    up = high - middle > 32767 ? -1 : 14 - (int)bits_of((uint32_t)(high - middle)); /* half of 65,535 is rounded up */
    for (i = 0; i < LABIAL_HEAR_WINDOW_; i++) {
        value = window[i] - middle;
        value = up < 0 ? value >> 1 : value * (1 << up);
        /* `up` is chosen for the largest. */
        /*@ assert -16384 <= value <= 16384; */
        LABIAL_CHECK(value >= -16384 && value <= 16384);
        window[i] = (int16_t)((value * ((32768 - cosine(i)) >> 1) + 16384) >> 15);
    }
    return up;
}

/* Turns a point by `turn` / 256 clockwise. */
static void put_turned(int16_t *point, int32_t re, int32_t im, unsigned turn)
{
    const int32_t c = cosine(turn), s = sine[turn];
    point[0] = (int16_t)((re * c + im * s + 16384) >> 15);
    point[1] = (int16_t)((im * c - re * s + 16384) >> 15);
}

/* A pass of the transform: joins points that are `quarter` pairs apart, four at a time. */
static void join_fours(int16_t *points, unsigned quarter)
{
    const unsigned step = 2u * quarter, turn = PAIRS / 2u / quarter;
    unsigned i, angle;
    for (i = 0, angle = 0; i < step; i += 2u, angle += turn) {
        int16_t *a = points + i;
        const int16_t *const last = a + (2u * PAIRS - 4u * step);
        for (;; a += 4u * step) {
            int16_t *const b = a + step, *const c = b + step, *const d = c + step;
            const int32_t er = a[0] + c[0] + 2, ei = a[1] + c[1] + 2, fr = a[0] - c[0] + 2, fi = a[1] - c[1] + 2;
            const int32_t gr = b[0] + d[0], gi = b[1] + d[1], hr = b[1] - d[1], hi = d[0] - b[0];
            a[0] = (int16_t)((er + gr) >> 2);
            a[1] = (int16_t)((ei + gi) >> 2);
            if (angle == 0u) {
                b[0] = (int16_t)((fr + hr) >> 2);
                b[1] = (int16_t)((fi + hi) >> 2);
                c[0] = (int16_t)((er - gr) >> 2);
                c[1] = (int16_t)((ei - gi) >> 2);
                d[0] = (int16_t)((fr - hr) >> 2);
                d[1] = (int16_t)((fi - hi) >> 2);
            } else {
                put_turned(b, (fr + hr) >> 2, (fi + hi) >> 2, angle);
                put_turned(c, (er - gr) >> 2, (ei - gi) >> 2, 2u * angle);
                put_turned(d, (fr - hr) >> 2, (fi - hi) >> 2, 3u * angle);
            }
            if (a == last)
                break;
        }
    }
}

/* The transform of 128 pairs as complex numbers, divided by 128; points are then in the order of point_of(). */
static void transform(int16_t points[LABIAL_HEAR_WINDOW_])
{
    int16_t *p;
    join_fours(points, 32);
    join_fours(points, 8);
    join_fours(points, 2);
    for (p = points; p < points + LABIAL_HEAR_WINDOW_; p += 4) {
        const int32_t ar = p[0] + 1, ai = p[1] + 1, br = p[2], bi = p[3];
        p[0] = (int16_t)((ar + br) >> 1);
        p[1] = (int16_t)((ai + bi) >> 1);
        p[2] = (int16_t)((ar - br) >> 1);
        p[3] = (int16_t)((ai - bi) >> 1);
    }
}

/* Where point k of the spectrum lies. */
static const int16_t *point_of(const int16_t *points, unsigned k)
{
    return points + 2u * ((k & 3u) << 5 | (k >> 2 & 3u) << 3 | (k >> 4 & 3u) << 1 | k >> 6);
}

/* Adds the power of a bin to the two bands that share it; band b is energy[b + 1]. */
static void share_power(uint32_t *energy, unsigned bin, int32_t re, int32_t im)
{
    const uint32_t power = (uint32_t)re * (uint32_t)re + (uint32_t)im * (uint32_t)im;
    const unsigned place = bin_places[bin - FIRST_BIN];
    const uint32_t part = place & 255u;
    const uint32_t above = (power >> 8) * part + (((power & 255u) * part) >> 8);
    energy += place >> 8;
    energy[0] += power - above;
    energy[1] += above;
}

/* Energies of the bands from the spectrum of pairs, which holds those of the even and the odd samples. Twice the
 * spectrum of the samples has moduli of up to 2^15, and its powers add up to less than 2^30. */
static void add_bands(const int16_t *points, uint32_t energy[LABIAL_HEAR_BANDS + 2])
{
    unsigned k;
    for (k = FIRST_BIN; k <= PAIRS / 2u; k++) {
        const int16_t *const p = point_of(points, k), *const q = point_of(points, PAIRS - k);
        const int32_t ar = p[0] + q[0], ai = p[1] - q[1], br = p[1] + q[1], bi = q[0] - p[0];
        const int32_t c = cosine(k), s = sine[k];
        int32_t tr, ti;
        /* The window's mean is a half, so that 2^13 sqrt 2 and some rounding is the bound of a point. */
        /*@ assert -32768 <= br <= 32768; */
        /*@ assert -32768 <= bi <= 32768; */
        LABIAL_CHECK(labial_clamp(br, 32768) == br && labial_clamp(bi, 32768) == bi);
        tr = (br * c + bi * s + 16384) >> 15;
        ti = (bi * c - br * s + 16384) >> 15;
        share_power(energy, k, ar + tr, ai + ti);
        if (k >= PAIRS - LAST_BIN && k < PAIRS / 2u)
            share_power(energy, PAIRS - k, ar - tr, ai - ti);
    }
}

/* Stages of a level: no voice was there, and the level stays; a voice was there, and the level falls fast until a hop
 * reaches it; then it follows. */
enum { WAITS, SEARCHES, FOLLOWS };

/* A hop begins a voice that is less than this below the level, or more than this above the quietest two hops. */
#define LEVEL_NEAR (4 * LABIAL_HEAR_LEVEL_ONE)
#define LEVEL_RISE (3 * LABIAL_HEAR_LEVEL_ONE)

void labial_hear_level_wait(labial_hear_level_t *level)
{
    level->stage = WAITS;
    level->quietest = level->before = LABIAL_HEAR_LEVEL_NONE;
}

/* Moves the level on by a hop. */
static void follow_level(labial_hear_level_t *level, int32_t now, int silent)
{
    if (level->stage == WAITS && !silent) {
        const int32_t louder = level->before > now ? level->before : now;
        if (louder < level->quietest)
            level->quietest = louder;
        if (now > level->level - LEVEL_NEAR || now > level->quietest + LEVEL_RISE)
            level->stage = SEARCHES;
    }
    level->before = silent ? LABIAL_HEAR_LEVEL_NONE : now;
    if (level->stage != WAITS) {
        level->level -= level->stage == SEARCHES ? LEVEL_SEARCH : LEVEL_FALL;
        if (level->level < LEVEL_LEAST)
            level->level = LEVEL_LEAST;
    }
    if (level->level <= now) {
        level->level = now;
        level->stage = FOLLOWS;
    }
}

void labial_hear_features(int16_t window[LABIAL_HEAR_WINDOW_], int silent, labial_hear_level_t *level,
                          int16_t features[LABIAL_HEAR_BANDS])
{
    uint32_t energy[LABIAL_HEAR_BANDS + 2];
    int32_t sum = 0, value;
    unsigned b;
    const int up = shape_window(window);
    memset(energy, 0, sizeof energy);
    if (up < 16) {
        transform(window);
        add_bands(window, energy);
    }
    for (b = 0; b < LABIAL_HEAR_BANDS; b++) {
        value = energy[b + 1u] > 0u ? log2_q8(energy[b + 1u]) + (12 - 2 * up) * 256 : 0;
        features[b] = (int16_t)(value > LOG_LEAST ? value : LOG_LEAST);
        sum += features[b];
    }
    follow_level(level, sum * 64, silent);
    value = (int32_t)labial_quotient((uint32_t)level->level, 64u * LABIAL_HEAR_BANDS);
    for (b = 0; b < LABIAL_HEAR_BANDS; b++) {
        int32_t relative = features[b] - value;
        if (relative < FEATURE_LEAST)
            relative = FEATURE_LEAST;
        else if (relative > FEATURE_MOST)
            relative = FEATURE_MOST;
        features[b] = (int16_t)((relative + FEATURE_OFFSET) >> 1);
    }
}

/* ---- Samples to windows ------------------------------------------------------------------------------------------ */

/* Whether the samples that a window has beyond the one before it are silent. */
static int is_silent(const int16_t *window)
{
    int32_t least = window[LABIAL_HEAR_SHARED], most = least;
    unsigned i;
    for (i = LABIAL_HEAR_SHARED + 1u; i < LABIAL_HEAR_WINDOW_; i++) {
        least = window[i] < least ? window[i] : least;
        most = window[i] > most ? window[i] : most;
    }
    return most - least <= SILENT_SPAN;
}

void labial_hear_features_reset(labial_hear_features_t *features)
{
    features->hop = 0;
    features->filled = 0;
    labial_hear_level_wait(&features->level);
}

size_t labial_hear_features_fill(labial_hear_features_t *features, const int16_t *samples, size_t count)
{
    const size_t room = features->filled > LABIAL_HEAR_SHARED ? LABIAL_HEAR_WINDOW_ - 1u - features->filled : 0u;
    if (count > room)
        count = room;
    memcpy(features->window + features->filled, samples, count * sizeof *samples);
    features->filled = (uint16_t)(features->filled + count);
    return count;
}

int labial_hear_features_take(labial_hear_features_t *features, int16_t sample)
{
    int16_t *const window = features->window;
    unsigned i;
    int silent;
    if (features->filled <= LABIAL_HEAR_SHARED) {
        if (features->filled == 0) /* the first sample */
            for (i = 0; i < LABIAL_HEAR_SHARED; i++)
                features->tail[i] = sample;
        features->filled = LABIAL_HEAR_SHARED;
        memcpy(window, features->tail, sizeof features->tail);
        features->loud &= features->hop;
    }
    window[features->filled++] = sample;
    if (features->filled < LABIAL_HEAR_WINDOW_)
        return 0;
    silent = is_silent(window);
    memcpy(features->tail, window + LABIAL_HEAR_HOP_, sizeof features->tail);
    labial_hear_features(window, silent, &features->level, features->bands + features->hop * LABIAL_HEAR_BANDS);
    if (!silent && labial_hear_level_voiced(&features->level))
        features->loud = 1;
    features->filled = LABIAL_HEAR_SHARED;
    features->hop ^= 1u;
    return features->hop == 0;
}
