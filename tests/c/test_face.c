/*
 * test_face.c - the contract of labial/face.h: calls drawn at random against a slow model in double; by hand what that
 * leaves out, sounds, limits of acceleration and other rates among it.
 */
#include "suite.h"
#include "labial/face.h"

enum {
    HOLD = LABIAL_FACE_HOLD,
    EASE = LABIAL_FACE_EASE,
    OUTPUTS = 3,
    AHEAD_MOST = 40,
    JAW_REST = 1400,
    JAW_WIDE = 1900,
    CANARY = -77
};

#define FAP3 0
#define FAP51 3
#define FAP52 4

static labial_face_t face;
static int32_t memory[LABIAL_FACE_SIZE(OUTPUTS, AHEAD_MOST) / 4 + 1];
static labial_rig_output_t outputs[OUTPUTS];
static labial_rig_t rig = { outputs, 1 };
static int32_t values[OUTPUTS + 1];

/* The first tests have one jaw, and begin a face of it. */
static void begin(int32_t slew, int32_t acceleration, unsigned ahead)
{
    outputs[0] = fixture_jaw(JAW_WIDE, slew, acceleration);
    rig.count = 1;
    memset(memory, 0xa5, sizeof memory);
    memory[LABIAL_FACE_SIZE(1, ahead) / 4] = CANARY;
    values[1] = CANARY;
    assert_ok(labial_rig_check(&rig));
    assert_ok(labial_face_init(&face, &rig, 50, ahead, memory, LABIAL_FACE_SIZE(1, ahead)));
    assert_int_equal(memory[LABIAL_FACE_SIZE(1, ahead) / 4], CANARY);
}

/* A frame that wants the jaw at `wanted`, 1536 .. 1900 or 1400. */
static void give(int32_t wanted)
{
    int16_t faps[LABIAL_CHANNELS] = { 0 };
    faps[FAP52] = (int16_t)(JAW_REST - wanted);
    labial_face_frame(&face, 12345, faps);
}

/* The jaw in the next tick, which must have that result. */
static int32_t tick(int result)
{
    assert_int_equal(labial_face_tick(&face, values), result);
    assert_int_equal(values[1], CANARY); /* nothing beyond the rig's outputs is written */
    return values[0];
}

/* ---- By hand ----------------------------------------------------------------------------------------------------- */

/* An output that follows sounds does so within the same limits, and goes to rest like any other. */
TEST(sounds_move_it)
{
    static const int16_t amounts[LABIAL_VISEMES] = { [LABIAL_VISEME_TH] = 128 };
    static const int16_t faps[LABIAL_CHANNELS] = { 0 };
    const uint8_t shares[LABIAL_VISEMES] = { [LABIAL_VISEME_TH] = 100 };
    begin(60, 0, 0);
    outputs[0].visemes = amounts;
    outputs[0].contact = 0;
    outputs[0].closed = 0;
    outputs[0].neutral = JAW_REST;
    assert_ok(labial_face_visemes(&face, faps, shares));
    assert_int_equal(tick(LABIAL_OK), JAW_REST + 60);
    assert_ok(labial_face_visemes(&face, faps, shares));
    assert_int_equal(tick(LABIAL_OK), JAW_REST + 100);
    assert_ok(labial_face_visemes(&face, faps, NULL));
    assert_int_equal(tick(LABIAL_OK), JAW_REST + 40);
    for (unsigned i = 0; i < HOLD + EASE && labial_face_tick(&face, values) != LABIAL_DONE; i++)
        assert_in_range(values[0], JAW_REST, JAW_REST + 40);
    assert_int_equal(values[0], JAW_REST);
    assert_int_equal(labial_face_visemes(&face, NULL, shares), LABIAL_ERROR_NULL);
}

TEST(look_ahead_is_that_of_the_rig)
{
    draw_from(7);
    for (unsigned round = 0; round < FIXTURE_ROUNDS(60); round++) {
        int16_t frames[120][LABIAL_CHANNELS] = { { 0 } };
        const unsigned ahead = below(AHEAD_MOST + 1u);
        int32_t value = JAW_REST, change = 0;
        begin(between(20, 200), round % 2 ? between(3, 60) : 0, ahead);
        for (unsigned i = 0; i < 120; i++) {
            frames[i][FAP52] = (int16_t)(i % 11u < 3u ? -between(0, 72) : -between(137, 500));
            frames[i][FAP51] = (int16_t)between(-5, 0);
            frames[i][FAP52] = (int16_t)(frames[i][FAP52] - frames[i][FAP51]);
        }
        for (unsigned i = 0; i < 120 + ahead; i++) {
            if (i < 120)
                labial_face_frame(&face, i, frames[i]);
            labial_face_tick(&face, values);
            if (i >= ahead) {
                const unsigned left = 120u + ahead - i;
                const unsigned known = left < ahead + 1u ? left : ahead + 1u;
                labial_rig_apply_ahead(&rig, frames[i - ahead], (uint16_t)known, &value, &change);
                assert_int_equal(values[0], value);
            }
        }
    }
}

TEST(errors_change_nothing)
{
    static const labial_rig_t none = { outputs, 0 }, empty = { NULL, 1 };
    static const int16_t faps[LABIAL_CHANNELS] = { 0 };
    static const uint8_t shares[LABIAL_VISEMES] = { 0 };
    static labial_face_t never;
    int32_t value = CANARY;
    begin(0, 0, 3);
    assert_int_equal(labial_face_init(NULL, &rig, 50, 0, memory, sizeof memory), LABIAL_ERROR_NULL);
    assert_int_equal(labial_face_init(&face, NULL, 50, 0, memory, sizeof memory), LABIAL_ERROR_NULL);
    assert_int_equal(labial_face_tick(&face, &value), LABIAL_ERROR_STATE);
    assert_int_equal(labial_face_init(&face, &empty, 50, 0, memory, sizeof memory), LABIAL_ERROR_NULL);
    assert_int_equal(labial_face_init(&face, &rig, 50, 0, NULL, sizeof memory), LABIAL_ERROR_NULL);
    assert_int_equal(labial_face_init(&face, &none, 50, 0, memory, sizeof memory), LABIAL_ERROR_RIG);
    assert_int_equal(labial_face_init(&face, &rig, 0, 0, memory, sizeof memory), LABIAL_ERROR_FRAME_RATE);
    assert_int_equal(labial_face_init(&face, &rig, 1001, 0, memory, sizeof memory), LABIAL_ERROR_FRAME_RATE);
    assert_int_equal(labial_face_init(&face, &rig, 50, LABIAL_FACE_AHEAD_MAX + 1, memory, sizeof memory),
                     LABIAL_ERROR_RANGE);
    assert_int_equal(labial_face_init(&face, &rig, 50, 3, memory, LABIAL_FACE_SIZE(1, 3) - 1), LABIAL_ERROR_WORKSPACE);
    for (unsigned i = 0; i < 2; i++) {
        labial_face_t *const bad = i ? &never : NULL;
        const int error = i ? LABIAL_ERROR_STATE : LABIAL_ERROR_NULL;
        labial_face_frame(bad, 0, faps);
        assert_int_equal(labial_face_visemes(bad, faps, shares), error);
        assert_int_equal(labial_face_values(bad, &value), error);
        assert_int_equal(labial_face_tick(bad, &value), error);
        assert_int_equal(labial_face_play(bad), error);
        assert_int_equal(labial_face_skip(bad, 1), error);
        assert_int_equal(labial_face_cancel(bad, 0), error);
        assert_int_equal(labial_face_soft_start(bad, 1), error);
        assert_int_equal(labial_face_place(bad, &value), error);
        assert_int_equal(labial_face_attached(bad), 0);
        assert_int_equal(labial_face_due(bad, 0), 0);
    }
    assert_int_equal(labial_face_values(&never, NULL), LABIAL_ERROR_NULL);
    assert_int_equal(labial_face_tick(&never, NULL), LABIAL_ERROR_NULL);
    assert_int_equal(labial_face_place(&never, NULL), LABIAL_ERROR_NULL);
    assert_int_equal(value, CANARY);
    begin(0, 0, 3);
    labial_face_frame(&face, 0, NULL);
    assert_int_equal(tick(LABIAL_DONE), JAW_REST);
}

/* ---- The clock --------------------------------------------------------------------------------------------------- */

/* Once per period, wherever the counter begins and wraps, and on time for rates that do not divide a second. */
TEST(clock_keeps_its_rate)
{
    static const uint32_t starts[] = { 0, 0x7ffffff0u, 0x80000000u, 0xfffffc18u, 0xffffffffu };
    static const unsigned rates[] = { 1, 7, 24, 25, 30, 50, 60, 300, 999, 1000 };
    for (unsigned s = 0; s < COUNT_OF(starts); s++) {
        for (unsigned r = 0; r < COUNT_OF(rates); r++) {
            begin(0, 0, 0);
            assert_ok(labial_face_init(&face, &rig, rates[r], 0, memory, sizeof memory));
            uint32_t count = 0;
            for (uint32_t ms = 0; ms < 10000; ms++) {
                while (labial_face_due(&face, starts[s] + ms)) {
                    give(1900);
                    assert_int_equal(tick(LABIAL_OK), 1900);
                    count++;
                }
                /* Tick n is due at n * 1000 / rate, up to a millisecond early. */
                assert_in_range(count, ms * rates[r] / 1000 + 1, (ms + 1) * rates[r] / 1000 + 1);
            }
        }
    }
}

/* How many ticks are due at a time, and how far the jaw moves in them, 10 units at once: after a delay the source catches
 * up, and the jaw moves by one tick. */
TEST(clock_catches_up)
{
    static const struct {
        uint32_t now;
        unsigned ticks;
        int32_t moved;
    } cases[] = {
        { 5000, 1, 10 },
        { 5019, 0, 0 },
        { 5020, 1, 10 },
        { 5199, 8, 10 },
        { 5200, 1, 0 }, /* a millisecond later: too soon to move */
        { 5229, 1, 10 },
        { 6220, 50, 10 },
        { 7241, 1, 10 }, /* 1,001 ms late: begins anew */
        { 7260, 0, 0 },
        { 7261, 1, 10 },
        { 7240, 1, 10 }, /* back */
        { 7259, 0, 0 },
        { 7260, 1, 10 },
        { 7260u - 0x7fffffffu, 1, 10 },
        { 7260u - 0x7fffffffu + 19u, 0, 0 },
        { 7260u - 0x7fffffffu + 20u, 1, 10 },
    };
    begin(10, 0, 0);
    tick(LABIAL_DONE);
    for (unsigned i = 0; i < COUNT_OF(cases); i++) {
        const int32_t before = values[0];
        unsigned count = 0;
        for (; labial_face_due(&face, cases[i].now); count++) {
            assert_true(count < 60);
            give(1900);
            tick(LABIAL_OK);
        }
        assert_int_equal(count, cases[i].ticks);
        assert_int_equal(values[0] - before, cases[i].moved);
    }
}

/* ---- Random calls, against a slow model in double ------------------------------------------------------------------ */

typedef struct {
    double frames[4096][OUTPUTS];
    long arrival[4096];
    size_t head, tail;
    long now;   /* ticks so far */
    long since; /* the tick at which the frames that wait began to */
    int plays;
    long silent; /* ticks without a frame, of which a cancel may skip the first */
    long left;   /* ticks of the way to rest */
    double wanted[OUTPUTS], value[OUTPUTS], change[OUTPUTS];
    long start, apart; /* of the soft start: its tick, and ticks from one output to the next, 0 for none */
    unsigned ahead;
} model_t;

static model_t model;

static void model_begin(unsigned ahead)
{
    memset(&model, 0, sizeof model);
    model.ahead = ahead;
    model.silent = HOLD + 1;
    for (unsigned i = 0; i < rig.count; i++)
        model.value[i] = model.wanted[i] = fixture_rest(&outputs[i]);
}

static void model_frame(const double *wanted)
{
    if (model.head == model.tail)
        model.since = model.now;
    if (model.tail == 4096) { /* room at the end */
        memmove(model.frames, model.frames + model.head, (model.tail - model.head) * sizeof model.frames[0]);
        model.tail -= model.head;
        model.head = 0;
    }
    memcpy(model.frames[model.tail++], wanted, rig.count * sizeof *wanted);
    if (model.tail - model.head > model.ahead + 1u)
        model.head++;
}

static void model_cancel(uint32_t ms)
{
    model.head = model.tail;
    if (model.silent < HOLD)
        model.silent = HOLD;
    if (model.left > 0)
        model.left = (long)fixture_limited(ceil(ms / 20.0), 1, 1000);
}

static void model_skip(unsigned count)
{
    for (; count > 0 && model.plays && model.head < model.tail; count--)
        model.head++;
}

static int model_follows(unsigned output)
{
    return model.apart == 0 || model.now - model.start >= model.apart * (long)(output + 1u);
}

/* A tick; outputs with a limit of acceleration are left to the caller. */
static void model_tick(int moves)
{
    const size_t held = model.tail - model.head;
    model.plays = held > 0 && (model.plays || held > model.ahead || model.now - model.since >= (long)model.ahead);
    model.silent = model.plays ? 0 : model.silent < HOLD + 1 ? model.silent + 1 : model.silent;
    if (model.plays)
        model.left = EASE;
    const long left = model.left;
    if (model.silent > HOLD && model.left > 0)
        model.left--;
    for (unsigned i = 0; i < rig.count; i++) {
        const labial_rig_output_t *output = &outputs[i];
        const double rest = fixture_rest(output);
        double wanted, step;
        if (model.plays) {
            model.wanted[i] = model.frames[model.head][i];
        } else if (model.silent > HOLD && left > 0) {
            if (fabs(rest - model.value[i]) < fabs(rest - model.wanted[i]))
                model.wanted[i] = model.value[i];
            step = floor(fabs(rest - model.wanted[i]) / (double)left);
            model.wanted[i] += model.wanted[i] < rest ? step : -step;
        }
        wanted = model.wanted[i];
        const int rests = !model_follows(i) || model.left == 0;
        if (rests)
            wanted = rest;
        else if (model.plays && output->contact && output->slew > 0)
            for (size_t k = 0; k < held; k++)
                if (model.frames[model.head + k][i] - output->closed == 0) {
                    wanted = fixture_limited(wanted, output->closed - (double)k * output->slew,
                                             output->closed + (double)k * output->slew);
                    break;
                }
        step = wanted - model.value[i];
        if (fabs(wanted - rest) > 0 && fabs(step) < output->deadband)
            step = 0;
        if (output->slew > 0)
            step = fixture_limited(step, -output->slew, output->slew);
        if (moves && output->acceleration == 0)
            model.value[i] += step;
    }
    if (model.plays)
        model.head++;
    model.now++;
}

/* A checked output whose FAPs are exact in double: of a servo mostly, or with numbers as large as can be. */
static labial_rig_output_t any_output(void)
{
    labial_rig_output_t output = { 0 };
    const int32_t most = below(6) ? 3000 : LABIAL_RIG_VALUE_MAX;
    output.weights[FAP3] = (int16_t)between(-4096, 4096);
    output.weights[FAP52] = (int16_t)between(-8192, 8192);
    output.gain = between(-(1 << 21), 1 << 21) >> below(12);
    output.minimum = between(-most, most);
    output.maximum = between(output.minimum, most);
    output.neutral = between(-most, most);
    output.invert = (uint8_t)below(2);
    output.contact = (uint8_t)below(2);
    output.closed = output.contact ? between(output.minimum, output.maximum) : 0;
    output.slew = below(4) ? 1 + (int32_t)below(1u << (1u + below(most > 3000 ? 23 : 9))) : 0;
    output.deadband = below(3) ? 0 : (int32_t)below(40);
    output.acceleration = below(2) ? 1 + (int32_t)below(1u << (1u + below(most > 3000 ? 23 : 7))) : 0;
    return output;
}

/* Long enough for every output to come to rest, by the header. */
static uint32_t time_to_rest(unsigned ahead)
{
    int32_t most = 0;
    for (unsigned i = 0; i < rig.count; i++) {
        const int32_t travel =
            LABIAL_FACE_TRAVEL(outputs[i].maximum - outputs[i].minimum, outputs[i].slew, outputs[i].acceleration);
        most = travel > most ? travel : most;
    }
    return ahead + HOLD + EASE + (uint32_t)most;
}

static int32_t last[OUTPUTS], before[OUTPUTS];

/* One tick of face and model, in which the outputs move or not; what is promised of each. */
static int tick_both(int moves)
{
    const long attached = model.apart > 0 ? (model.now - model.start) / model.apart + 1 : OUTPUTS;
    assert_int_equal(labial_face_attached(&face), attached < rig.count ? attached : rig.count);
    const int result = labial_face_tick(&face, values);
    const int waits = model.tail > model.head;
    int rests = 1;
    assert_true(result >= 0);
    model_tick(moves);
    for (unsigned i = 0; i < rig.count; i++) {
        const labial_rig_output_t *output = &outputs[i];
        const int32_t change = values[i] - last[i];
        assert_true(values[i] >= output->minimum && values[i] <= output->maximum);
        assert_true(output->slew == 0 || (change <= output->slew && change >= -output->slew));
        if (moves && output->acceleration)
            assert_true(change - before[i] <= output->acceleration && before[i] - change <= output->acceleration);
        if (output->acceleration)
            model.value[i] = values[i];
        assert_near(values[i], model.value[i], 0);
        if (moves)
            before[i] = change;
        else
            assert_int_equal(change, 0);
        rests = rests && fabs(fixture_rest(output) - values[i]) == 0;
        last[i] = values[i];
    }
    assert_int_equal(values[rig.count], CANARY);
    assert_true(result != LABIAL_DONE || (rests && !waits));
    assert_int_equal(result == LABIAL_OK, model.plays);
    assert_int_equal(result == LABIAL_WAITING, waits && !model.plays);
    return result;
}

/* The clock in 64 bits: whether a tick is due, and whether outputs move in it. */
static int64_t now, due, moved_at;
static int is_timed;

static int model_due(int *moves)
{
    if (is_timed && now < due && due - now <= 21)
        return 0;
    if (!is_timed || now < due || now - due > 1000) {
        due = now;
        moved_at = now - 20;
    }
    is_timed = 1;
    due += 20;
    *moves = now - moved_at >= 10;
    moved_at = *moves ? now : moved_at;
    return 1;
}

static void any_frame(void)
{
    double wanted[OUTPUTS];
    if (below(4)) {
        int16_t faps[LABIAL_CHANNELS] = { 0 };
        const int32_t most = below(8) ? 500 : INT16_MAX;
        if (below(5)) {
            faps[FAP3] = (int16_t)between(-most, most);
            faps[FAP51] = (int16_t)between(-most, most);
            faps[FAP52] = (int16_t)between(-most, most);
        }
        for (unsigned i = 0; i < rig.count; i++)
            wanted[i] = fixture_output(&outputs[i], faps, NULL);
        labial_face_frame(&face, chance(), faps);
    } else {
        int32_t numbers[OUTPUTS];
        for (unsigned i = 0; i < rig.count; i++) {
            numbers[i] = below(9) ? between(outputs[i].minimum, outputs[i].maximum)
                                  : (int32_t)(chance() & 0x7fffffffu) - 0x40000000;
            wanted[i] = fixture_limited(numbers[i], outputs[i].minimum, outputs[i].maximum);
        }
        assert_ok(labial_face_values(&face, numbers));
    }
    model_frame(wanted);
}

/* Any calls in any order: what was promised holds in every tick, and once nothing more comes, everything rests in time. */
TEST(contract_holds_for_all_calls)
{
    static uint32_t rests;
    draw_from(11);
    for (unsigned round = 0; round < FIXTURE_ROUNDS(700); round++) {
        const unsigned ahead = below(3) ? below(8) : below(AHEAD_MOST + 1u);
        rig.count = (uint16_t)(1u + below(OUTPUTS));
        for (unsigned i = 0; i < rig.count; i++)
            outputs[i] = any_output();
        assert_ok(labial_rig_check(&rig));
        const size_t size = LABIAL_FACE_SIZE(rig.count, ahead);
        memset(memory, 0xa5, sizeof memory);
        memory[size / 4] = CANARY;
        values[rig.count] = CANARY;
        assert_ok(labial_face_init(&face, &rig, 50, ahead, memory, size));
        model_begin(ahead);
        labial_rig_rest(&rig, last);
        memset(before, 0, sizeof before);
        now = below(2) ? chance() : UINT32_MAX - 200;
        is_timed = 0;
        for (unsigned phase = 0; phase < 6; phase++) {
            const unsigned steady = below(4); /* a source that is never late, or one that often is */
            for (unsigned call = 0; call < 80; call++) {
                const unsigned late = below(6);
                uint32_t slow;
                switch (steady ? 0 : below(26)) {
                case 25:
                    assert_ok(labial_face_play(&face));
                    model.plays = model.plays || model.tail > model.head;
                    break;
                case 24:
                    assert_ok(labial_face_skip(&face, late));
                    model_skip(late);
                    break;
                case 20:
                    slow = late < 5 ? late * late * 13 : UINT32_MAX;
                    assert_ok(labial_face_cancel(&face, slow));
                    model_cancel(slow);
                    break;
                case 21:
                    slow = late < 5 ? below(31) : 255 + below(1000);
                    model.apart = (long)fixture_limited(slow, 1, 255);
                    model.start = model.now;
                    assert_ok(labial_face_soft_start(&face, slow));
                    break;
                case 22:
                    for (unsigned i = 0; i < rig.count; i++) {
                        last[i] = between(outputs[i].minimum, outputs[i].maximum);
                        before[i] = 0;
                        model.value[i] = last[i];
                    }
                    model.apart = 0;
                    assert_ok(labial_face_place(&face, last));
                    break;
                case 23:
                    for (unsigned burst = below(2 * ahead + 3); burst > 0; burst--)
                        any_frame();
                    break;
                case 19: /* a clock that stands still, goes on and jumps far, forward and back */
                    now += below(2)   ? (int64_t)below(60)
                           : below(2) ? (int64_t)below(1200)
                                      : between(-(1 << 29), 1 << 29);
                    int moves = 1;
                    assert_int_equal(labial_face_due(&face, (uint32_t)now), model_due(&moves));
                    tick_both(moves);
                    break;
                default:
                    if (steady || below(3))
                        any_frame();
                    tick_both(1);
                }
            }
            /* Nothing more comes. */
            const uint32_t most = time_to_rest(ahead) + (uint32_t)(model.apart * (long)rig.count);
            if (most > 20000) /* a servo that takes hours */
                continue;
            const uint32_t longer = model.left > EASE ? (uint32_t)model.left : 0;
            uint32_t ticks = 0;
            while (tick_both(1) != LABIAL_DONE)
                assert_true(++ticks <= most + longer);
            rests++;
            for (unsigned i = 0; i < 3; i++)
                assert_int_equal(tick_both(1), LABIAL_DONE);
        }
        assert_int_equal(memory[size / 4], CANARY);
    }
    assert_true(rests > FIXTURE_ROUNDS(700));
}

/* A table that was not checked: whatever comes out, no sanitizer may object and nothing else is written. */
TEST(unchecked_rigs_stay_defined)
{
    draw_from(3);
    for (unsigned round = 0; round < FIXTURE_ROUNDS(3000); round++) {
        uint8_t *bytes = (uint8_t *)outputs;
        rig.count = 1;
        for (unsigned i = 0; i < offsetof(labial_rig_output_t, curve); i++)
            bytes[i] = (uint8_t)(below(3) ? below(256) : below(2) ? 0x80 : 0xff);
        outputs[0].curve = NULL;
        values[1] = CANARY;
        assert_ok(labial_face_init(&face, &rig, 1u + below(1000), 3, memory, sizeof memory));
        for (unsigned i = 0; i < 20; i++) {
            int32_t any = (int32_t)(chance() & 0x7fffffffu) - (int32_t)below(0x7fffffff);
            give((int32_t)below(3000));
            labial_face_values(&face, &any);
            if (below(8) == 0)
                labial_face_place(&face, &any);
            labial_face_due(&face, chance());
            labial_face_tick(&face, values);
            assert_int_equal(values[1], CANARY);
        }
    }
}

SUITE(NULL, NULL)
