/*
 * test_clock.c - the loudspeaker's clock (labial/clock.h), against one that keeps every sound and its begin, in fractions.
 */
#include "suite.h"
#include "labial/clock.h"

enum { SOUNDS = 400 };

static labial_clock_t clock;

/* ---- A clock that is plain: times are in seconds times a million times the rate ---------------------------------- */

static struct {
    int64_t first, count, begin; /* begin: microseconds times the rate */
} plain[SOUNDS];
static unsigned sounds;
static int64_t plain_silent, plain_rate;

static void plain_play(int64_t first, int64_t count, int64_t now)
{
    if (sounds == 0 || plain_silent < now * plain_rate)
        plain_silent = now * plain_rate;
    plain[sounds].first = first;
    plain[sounds].count = count;
    plain[sounds].begin = plain_silent;
    plain_silent += count * 1000000;
    sounds++;
}

/* The sound that is heard, or the last one before; -1 without one. */
static int plain_sound(int64_t now)
{
    int k = (int)sounds - 1;
    while (k >= 0 && plain[k].begin > now * plain_rate)
        k--;
    return k;
}

/* Catches a clock that counts what was written, not what is heard; one that drifts by the fractions of a microsecond that
 * a block lasts; and one that wraps after 2^31 or 2^32 samples or microseconds. */
TEST(samples_are_heard_one_after_the_other)
{
    static const uint32_t rates[] = { 8000, 11025, 22050, 44100, 48000, 1000000 };
    static const int64_t starts[] = { 0, 0x7ffffff0, 0xfffffff0, INT64_C(1) << 40 };
    for (unsigned round = 0; round < 24; round++) {
        const int64_t rate = rates[round % 6], start = starts[round / 6];
        int64_t now = start / 2, number = start, sample;
        assert_int_equal(labial_clock_init(&clock, (uint32_t)rate), 0);
        assert_int_equal(labial_clock_at(&clock, now, &sample), -1);
        assert_int_equal(sample, 0);
        sounds = 0;
        plain_rate = rate;
        for (unsigned k = 0; k < SOUNDS; k++) {
            const uint32_t count = 1 + below((uint32_t)rate / 20);
            plain_play(number, count, now);
            labial_clock_play(&clock, number, count, now);
            number += count;
            for (unsigned i = 0; i < 3; i++) { /* up to the end of what was given */
                const int64_t left = plain_silent / rate - now, at = now + below((uint32_t)left + 1);
                const int found = plain_sound(at);
                const int64_t heard = (at * rate - plain[found].begin) / 1000000;
                assert_int_equal(labial_clock_at(&clock, at, &sample), 0);
                if (heard < plain[found].count) /* a microsecond is a sample at most */
                    assert_in_range(sample - plain[found].first - heard + 1, 0, 3);
            }
            if (below(20) == 0) { /* a gap */
                now = plain_silent / rate + 1 + below(3000000);
                assert_in_range(labial_clock_at(&clock, now, &sample) - (now - plain_silent / rate) + 1, 0, 2);
                assert_int_equal(sample, number - 1);
            } else { /* a driver that holds a little */
                const int64_t room = plain_silent / rate - 60000;
                now = room > now ? room : now;
            }
        }
    }
}

/* Catches an error that grows: after a day without a pause it would be seconds. */
TEST(a_day_of_blocks_is_a_day)
{
    const int64_t blocks = 86400 * 43;
    int64_t sample;
    assert_int_equal(labial_clock_init(&clock, 44100), 0);
    for (int64_t k = 0; k < blocks; k++) /* each is given 50 ms before the one before it ends */
        labial_clock_play(&clock, k * 1024, 1024, k * 10240000 / 441 - 50000);
    assert_int_equal(labial_clock_at(&clock, blocks * 10240000 / 441 - 50000 - 10000, &sample), 0);
    assert_in_range(blocks * 1024 - sample, 440, 442); /* 10 ms before the end, which the first write moved by 50 ms */
}

/* The sample that is heard, from a clock that runs. */
static int64_t heard_at(int64_t now)
{
    int64_t sample;
    assert_int_equal(labial_clock_at(&clock, now, &sample), 0);
    return sample;
}

/* Catches numbers of dropped sound that are heard, ones of a sound that has none, and a sound that goes on after it was
 * silenced. */
TEST(other_numbers)
{
    int64_t sample;
    assert_int_equal(labial_clock_init(&clock, 1000), 0);
    labial_clock_play(&clock, LABIAL_CLOCK_NONE, 100, 0);
    assert_int_equal(heard_at(50000), 0);
    labial_clock_play(&clock, 40, 100, 50000); /* heard from 100 ms on */
    assert_int_equal(heard_at(99000), 40);
    assert_int_equal(heard_at(150000), 90);
    labial_clock_play(&clock, 1000, 100, 150000); /* the numbers between were dropped; heard from 200 ms on */
    assert_int_equal(heard_at(199000), 1000);
    assert_int_equal(heard_at(250000), 1050);
    labial_clock_play(&clock, LABIAL_CLOCK_NONE, 500, 250000);
    assert_int_equal(heard_at(700000), 1099);
    labial_clock_play(&clock, 1100, 100, 700000); /* heard from 800 ms on */
    assert_int_equal(heard_at(850000), 1150);
    labial_clock_stop(&clock);
    assert_int_equal(labial_clock_at(&clock, 860000, &sample), -1);
    assert_int_equal(sample, 1199); /* the last one that was given, not 1160, the last one that was heard */
    labial_clock_play(&clock, 1200, 100, 860000); /* at once */
    assert_int_equal(heard_at(870000), 1210);
    assert_int_equal(labial_clock_at(&clock, 970000, &sample), 10000);
    assert_int_equal(sample, 1299);
    labial_clock_play(&clock, 1300, 0, 970000); /* nothing */
    assert_int_equal(labial_clock_at(&clock, 970000, &sample), 10000);
}

/* Catches a rate of 0 by which is divided, and numbers that overflow. */
TEST(what_cannot_be)
{
    static const int64_t times[] = { INT64_MIN, -1, 0, 1, INT64_MAX };
    int64_t sample;
    memset(&clock, 0xff, sizeof clock);
    assert_int_equal(labial_clock_init(NULL, 44100), LABIAL_ERROR_NULL);
    assert_int_equal(labial_clock_init(&clock, 0), LABIAL_ERROR_SAMPLE_RATE);
    labial_clock_play(&clock, 0, 100, 0);
    assert_int_equal(labial_clock_at(&clock, 0, &sample), -1);
    assert_ok(labial_clock_init(&clock, 1000));
    labial_clock_play(&clock, 0, 1000, INT64_MIN); /* at -LABIAL_CLOCK_MAX */
    assert_int_equal(labial_clock_at(&clock, INT64_MAX, &sample), 2 * LABIAL_CLOCK_MAX - 1000000);
    assert_int_equal(labial_clock_at(&clock, INT64_MIN, &sample), 0);
    assert_int_equal(sample, 0);
    labial_clock_play(&clock, INT64_MAX, 1000, INT64_MAX);
    assert_int_equal(labial_clock_at(&clock, INT64_MAX, &sample), 0);
    assert_int_equal(sample, LABIAL_CLOCK_MAX);
    assert_int_equal(labial_clock_init(&clock, LABIAL_CLOCK_SAMPLE_RATE_MAX + 1), LABIAL_ERROR_SAMPLE_RATE);
    labial_clock_play(&clock, 0, 100, 0);
    labial_clock_stop(&clock);
    assert_int_equal(labial_clock_at(&clock, 0, &sample), -1);
    for (unsigned i = 0; i < 125; i++) {
        assert_int_equal(labial_clock_init(&clock, i % 2 ? 1 : LABIAL_CLOCK_SAMPLE_RATE_MAX), 0);
        for (unsigned k = 0; k < 5; k++) {
            labial_clock_play(&clock, times[i % 5], UINT32_MAX - k, times[i / 5 % 5]);
            assert_true(labial_clock_at(&clock, times[i / 25], &sample) >= 0);
            assert_true(sample >= 0);
        }
    }
    assert_int_equal(labial_clock_init(&clock, 1), 0);
    labial_clock_play(&clock, 0, UINT32_MAX, 0); /* a day of them waits */
    assert_int_equal(labial_clock_at(&clock, 0, &sample), 0);
    assert_int_equal(sample, UINT32_MAX - 86400);
    assert_int_equal(labial_clock_at(&clock, LABIAL_CLOCK_AHEAD + 7, &sample), 7);
}

SUITE(NULL, NULL)
