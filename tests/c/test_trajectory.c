/*
 * test_trajectory.c - equation 3 in integers, against oracle_trajectory.c, which solves it in doubles: whole solutions, and
 * such of which the backward pass begins before the end; and its quotients against exact ones.
 */
#include "suite.h"
#include "oracle.h"
#include "trajectory.h"
#include "units.h"

#define FRAMES 60
#define CHANNEL 3 /* of a frame */
#define STATES 12 /* that a path may take; the others of the model are like the first */

static fixture_model_t model;
static labial_state_t states[LABIAL_STATES_MAX];
static labial_channel_t channel;
static uint8_t path[FRAMES];
static int16_t target[FRAMES];
static uint16_t contact[FRAMES]; /* bit 0 */
static int32_t gain[FRAMES];     /* articulation, in 1/256 */
static double worst, sum_of_squares;
static unsigned long compared;

/* The limits that the solver is promised: labial_model_check() itself says whether a test keeps to them. */
static void require_accepted(void)
{
    for (unsigned q = STATES; q < LABIAL_STATES_MAX; q++)
        states[q] = states[0];
    model.channels[0].states = states;
    channel = model.channels[0];
    assert_ok(labial_model_check(&model.model));
}

/* The library's forward pass, on a solver that holds what another solution left: runs of frames of one state together,
 * as many as `most`. */
static void go_forward(unsigned length, unsigned most, labial_factors_t *factors)
{
    labial_frame_t frames[FRAMES];
    labial_solver_t solver;
    labial_terms_t terms;
    unsigned run;
    memset(&solver, 0x55, sizeof solver);
    memset(solver.shifts, 0, sizeof solver.shifts); /* as a reset leaves them */
    memset(frames, 0x55, sizeof frames);
    for (unsigned t = 0; t < length; t++) {
        frames[t].target[CHANNEL] = target[t];
        frames[t].contacts = (t % 2u ? ~((uint32_t)1 << CHANNEL) : 0u) | (uint32_t)contact[t] << CHANNEL;
        frames[t].marks =
            (uint8_t)((t == 0 ? LABIAL_BEGINS : 0) | (t + 1 == length ? LABIAL_ENDS | LABIAL_UNIT_ENDS : 0));
    }
    for (unsigned t = 0; t < length; t += run) {
        for (run = 1; run < most && t + run < length && path[t + run] == path[t] && gain[t + run] == gain[t];)
            run++;
        labial_trajectory_terms(&channel, path[t], gain[t], &terms);
        labial_trajectory_rows(&solver, &terms, frames + t, CHANNEL, run, factors + t);
    }
}

/* The largest articulation, 1 at least. */
static double most_gain(void)
{
    int32_t most = LABIAL_GAIN_ONE;
    for (unsigned t = 0; t < FRAMES; t++)
        most = gain[t] > most ? gain[t] : most;
    return most / 256.0;
}

/* An error in FAP units must be .1 at most, in proportion to the largest articulation beyond 1; motion beyond 16 bits must
 * be at their end. */
static void judge(int got, double wanted)
{
    const double limited = fixture_limited(wanted, -INT16_MAX, INT16_MAX), error = fabs(got - limited) / 16.0;
    assert_near(got / 16.0, limited / 16.0, 0.1 * most_gain());
    worst = error > worst ? error : worst;
    sum_of_squares += error * error;
    compared++;
}

/* Whole solutions, and such as go back from `window` frames ahead. */
static void compare(unsigned length, unsigned round)
{
    static int16_t motion[FRAMES];
    labial_factors_t before[FRAMES + 2], *factors = before + 1; /* to either side what must stay as it is */
    const unsigned window = round % 2 ? LABIAL_WINDOW : round % 13;
    double wanted[FRAMES];
    size_t start[FRAMES];
    require_accepted();
    memset(before, 0x3c, sizeof before);
    go_forward(length, 1 + round % 9, factors);
    assert_int_equal(factors[-1].q, 0x3c3c3c3c);
    assert_int_equal(factors[length].q, 0x3c3c3c3c);
    oracle_trajectory(&channel, path, target, contact, 0, gain, length, NULL, wanted);
    memset(motion, 0x77, sizeof motion);
    labial_trajectory_back(factors + length - 1, 0, length, length - 1, FRAMES, motion);
    for (unsigned t = 0; t < length; t++)
        judge(motion[t], wanted[t]);
    for (unsigned i = length; i < FRAMES; i++)
        assert_int_equal(motion[i], 0x7777); /* other frames are not its own */
    for (unsigned t = 0; t < length; t++)
        start[t] = t + window < length ? t + window : length - 1;
    oracle_trajectory(&channel, path, target, contact, 0, gain, length, start, wanted);
    for (unsigned t = 0; t < length; t++) {
        labial_trajectory_back(factors + start[t], (unsigned)start[t] - t, 1, 0, 1, motion);
        judge(motion[0], wanted[t]);
    }
}

/* The largest weight that is not above `value`. */
static uint8_t not_above(double value)
{
    unsigned code = 255;
    while (fixture_weight_value((uint8_t)code) > value)
        code--;
    return (uint8_t)code;
}

static const uint8_t shares[] = { 0, 127, 128, 255, 1, 254, 64, 200 };

/* Random states: holds from 8 to `hold`, of any size alike or only these two; stiffness up to `stiff` times the hold, or
 * as much as the sum allows; `pull` of what the pulls may be. */
static void make(fixture_random_t *random, double hold, double stiff, double pull, int only_bounds)
{
    const double room = (LABIAL_WEIGHT_SUM_MAX - hold) / 8.0;
    double weakest = hold, mean[STATES][2];
    for (unsigned q = 0; q < STATES; q++) {
        labial_state_t *s = &states[q];
        const double r = only_bounds ? fixture_below(random, 2) : fixture_below(random, 1001) / 1000.0;
        const double own = LABIAL_WEIGHT_MIN * pow(hold / LABIAL_WEIGHT_MIN, r);
        s->hold = not_above(own + 1e-6);
        weakest = fmin(weakest, fixture_weight_value(s->hold));
        s->weight[1] =
            not_above(fmin(room, fixture_weight_value(s->hold) * stiff *
                                     (only_bounds ? 1.0 : pow(1000.0, -(double)fixture_below(random, 1001) / 1000.0))));
        s->weight[0] =
            only_bounds && fixture_below(random, 2) ? s->weight[1] : (uint8_t)fixture_below(random, s->weight[1] + 1u);
        s->share = fixture_below(random, 2) ? shares[fixture_below(random, 8)] : (uint8_t)fixture_below(random, 256);
        s->mean = (int16_t)((int)fixture_below(random, 2 * LABIAL_POSITION_MAX + 1) - LABIAL_POSITION_MAX);
    }
    for (unsigned q = 0; q < STATES; q++) {
        const labial_state_t *s = &states[q];
        const double all = pull * LABIAL_PULL_MAX * weakest / 4.0, part = fixture_below(random, 3) / 2.0;
        const double d = fixture_weight_value(s->weight[0]), dd = fixture_weight_value(s->weight[1]);
        /* all states have the same part of it, of the same sign or not */
        mean[q][0] = fmin(LABIAL_POSITION_MAX, all * (q ? 0.5 : part) / (d > 0 ? d : 1));
        mean[q][1] = fmin(LABIAL_POSITION_MAX, all * (q ? 0.5 : fmin(part, 0.5)) / (dd > 0 ? dd : 1));
        if (q == 0 && part > 0.5)
            mean[q][0] /= 2;
    }
    for (unsigned i = 0; i < 2; i++) {
        uint16_t *const scale = &model.channels[0].motion_scale[i];
        double most = 0;
        for (unsigned q = 0; q < STATES; q++)
            most = fmax(most, mean[q][i]);
        *scale = (uint16_t)floor(fmax(most - 0.5, 0) * 256.0 / 127.0);
        for (unsigned q = 0; q < STATES; q++) {
            const int steps = (int)(*scale ? fmin(127, floor(fmax(mean[q][i] - 0.5, 0) * 256.0 / *scale)) : 0);
            states[q].motion[i] = (int8_t)(fixture_below(random, 2) ? -steps : steps);
        }
    }
}

/* What holds frames in contact: nothing, as much as the sum has room for beside the states', or any weight below it. */
static void make_firm(fixture_random_t *random)
{
    double room = LABIAL_WEIGHT_SUM_MAX, delta = 0, delta2 = 0;
    unsigned q;
    for (q = 0; q < STATES; q++) {
        delta = fmax(delta, fixture_weight_value(states[q].weight[0]));
        delta2 = fmax(delta2, fixture_weight_value(states[q].weight[1]));
    }
    room -= 2 * delta + 6 * delta2;
    q = fixture_below(random, 3);
    model.channels[0].contact_weight =
        q == 0 ? 0 : not_above(q == 1 ? room : room * fixture_below(random, 1001) / 1000.0);
}

/* A path that stays for three frames on average, or for none; targets that switch from end to end or lie anywhere; frames
 * in contact by chance, single ones and several together, or all. */
static void walk(fixture_random_t *random, int restless, int extreme)
{
    const uint32_t touching = fixture_below(random, 4);
    make_firm(random);
    for (unsigned t = 0; t < FRAMES; t++) {
        const int anywhere = (int)fixture_below(random, 2 * LABIAL_POSITION_MAX + 1) - LABIAL_POSITION_MAX;
        path[t] =
            (uint8_t)(t > 0 && !restless && fixture_below(random, 3) ? path[t - 1] : fixture_below(random, STATES));
        target[t] = (int16_t)(!extreme                                 ? anywhere
                              : (t + fixture_below(random, 8) / 7) % 2 ? LABIAL_POSITION_MAX
                                                                       : -LABIAL_POSITION_MAX);
        contact[t] = (uint16_t)(fixture_below(random, 3) < touching);
    }
}

/* 2^54 / d, to 24 bits, of an even `d` of 2^30 at least: a pull of 2^30 in Q16 moves a frame that nothing holds, whose row
 * sum is half of d, and whose D is nearly 2^31. */
static uint32_t reciprocal_of(uint32_t d)
{
    labial_factors_t factors[2];
    labial_solver_t solver = { 0 };
    labial_terms_t terms = { 0 };
    labial_frame_t frame = { 0 };
    solver.row = (int32_t)(d / 2u);
    solver.bent = (int32_t)(((uint32_t)1 << 31) - 2u - d / 2u - ((uint32_t)1 << 24));
    solver.pull = (int32_t)1 << 30;
    terms.stiff = 256;
    labial_trajectory_rows(&solver, &terms, &frame, 0, 1, factors + 1);
    return (uint32_t)factors[0].q / 2u;
}

/* The error that Newton's steps have to square, of the best guess that 8 bits can make for all numbers of an interval. */
static double least_guess_error(double from, double to)
{
    double best = 1.0;
    for (unsigned r = 128; r < 256; r++)
        best = fmin(best, fmax(fabs(1.0 - from * r / 256.0), fabs(to * r / 256.0 - 1.0))); /* at the worse end */
    return best;
}

/* Near the ends of each 64th of the range, where a guess for all of it is worst. A step x += x (1 - d x) leaves the square
 * of the relative error; the first step's result has 16 bits, of which the last is lost. What is lost beyond the square of
 * that are the last bits of 1 - d x (x / 2^18) and of the result (1). Would catch a guess that is not the best, or nearly
 * as good, and bits that a step does without. */
TEST(reciprocals_have_24_bits)
{
    const unsigned blocks = LABIAL_TEST_SHARE > 2 ? 1 : 16; /* each of which shares the first step */
    for (unsigned i = 64; i < 128; i++) {
        const double from = i / 64.0, to = (i + 1) / 64.0, guessed = least_guess_error(from, to);
        const double stepped = guessed * guessed + from / 65536.0;
        const double most = 1.0 + 65536.0 / from / 262144.0 + 16777216.0 / from * stepped * stepped;
        for (unsigned block = 0; block < 2u * blocks; block++) {
            const uint32_t first =
                block < blocks ? (i << 24) + (block << 15) : ((i + 1u) << 24) - ((block + 1u - blocks) << 15);
            for (unsigned k = 0; k < 512; k += 2) {
                const double lost = 18014398509481984.0 / (first + k) - reciprocal_of(first + k);
                assert_true(lost <= most && lost >= -0.1);
            }
        }
    }
}

/* As trained models are: hardly any error beyond that of rounding. */
TEST(ordinary_weights)
{
    fixture_random_t random = { 21 };
    worst = sum_of_squares = 0;
    compared = 0;
    for (unsigned round = 0; round < FIXTURE_ROUNDS(1500); round++) {
        make(&random, 600, 4, 0.02, 0);
        walk(&random, 0, 0);
        compare(1 + round % FRAMES, round);
    }
    assert_true(compared > FIXTURE_ROUNDS(10000));
    assert_true(sqrt(sum_of_squares / (double)compared) < 0.03); /* rounding to 1/16 alone is 0.018 */
}

/* All magnitudes that labial_model_check() lets pass, with pulls and without, on every kind of path. */
TEST(any_weights_within_the_limits)
{
    static const double holds[] = { 8, 30, 127, 1000, 8000, 15872 };
    fixture_random_t random = { 22 };
    for (unsigned round = 0; round < FIXTURE_ROUNDS(6000); round++) {
        make(&random, holds[round % 6], LABIAL_STIFFNESS_MAX, round / 6 % 3 / 2.0, 0);
        walk(&random, round / 18 % 2, round / 36 % 2);
        compare(1 + round % 7 * 59 / 6, round);
    }
}

/* Only weights at their bounds: the weakest and the strongest hold, the stiffest motion, the largest sum and pull. Would
 * catch an overflow, and a limit that promises more than the solver keeps. */
TEST(every_bound)
{
    static const double holds[] = { 8, 8, 16, 120, 126, 1920, 7936, 15872 };
    fixture_random_t random = { 23 };
    for (unsigned round = 0; round < FIXTURE_ROUNDS(8000); round++) {
        make(&random, holds[round % 8], LABIAL_STIFFNESS_MAX, round / 8 % 2, 1);
        walk(&random, round / 16 % 2, round / 32 % 3 > 0);
        compare(round % 5 ? FRAMES : 1 + round / 5 % FRAMES, round);
    }
    print_message("worst error %.4f FAP\n", worst);
}

/* The same with every articulation: none, the largest, one for each frame, and changes between the ends. */
TEST(every_articulation)
{
    static const double holds[] = { 8, 16, 126, 600, 7936, 15872 };
    static const int32_t gains[] = { 0, 1, 128, 255, 257, 333, 511, 512 };
    fixture_random_t random = { 31 };
    worst = 0;
    for (unsigned round = 0; round < FIXTURE_ROUNDS(6000); round++) {
        make(&random, holds[round % 6], LABIAL_STIFFNESS_MAX, round / 6 % 3 / 2.0, round / 18 % 2);
        walk(&random, round / 36 % 2, round / 72 % 2);
        for (unsigned t = 0; t < FRAMES; t++)
            gain[t] = t > 0 && round % 4 == 0              ? gain[0]
                      : t > 0 && round % 4 == 1            ? 512 - gain[t - 1]
                      : t > 0 && fixture_below(&random, 3) ? gain[t - 1]
                                                           : gains[fixture_below(&random, 8)];
        compare(round % 5 ? FRAMES : 1 + round / 5 % FRAMES, round);
    }
    for (unsigned t = 0; t < FRAMES; t++)
        gain[t] = LABIAL_GAIN_ONE;
    print_message("worst error %.4f FAP\n", worst);
}

/* Solves forward row by row; returns the largest pivot, of 2^30. What the solver's next row makes of the pending frame are,
 * in Q16, its hold, its ties to either side and, all together, the pivot. */
static double largest_pivot(unsigned length)
{
    labial_factors_t factors[FRAMES + 1];
    labial_solver_t solver = { 0 };
    labial_terms_t terms;
    double most = 0;
    require_accepted();
    for (unsigned t = 0; t < length; t++) {
        const int is_last = t + 1 == length;
        labial_frame_t frame = { 0 };
        frame.target[CHANNEL] = target[t];
        frame.contacts = (uint32_t)contact[t] << CHANNEL;
        frame.marks = (uint8_t)((t == 0 ? LABIAL_BEGINS : 0) | (is_last ? LABIAL_ENDS : 0));
        labial_trajectory_terms(&channel, path[t], gain[t], &terms);
        if (t > 0) {
            const int64_t hold = (int64_t)solver.hold * 65536, held = hold + solver.row - solver.k2;
            const int64_t before = ((int64_t)solver.delta + (is_last ? 0 : terms.delta)) * 131072 + solver.bent;
            const int64_t behind = is_last ? 0 : (int64_t)terms.stiff * 65536;
            const int64_t pivot = (held < hold ? hold : held) + before + behind;
            assert_true(before >= 0 && behind >= 0);
            assert_in_range(pivot, 1 << 19, (1 << 30) - 1);
            most = fmax(most, (double)pivot / 1073741824.0);
        }
        labial_trajectory_rows(&solver, &terms, &frame, CHANNEL, 1, factors + t);
    }
    return most;
}

/* The bound that lib/trajectory.c derives, on paths by chance and on the accepted weights whose diagonal is largest: for each
 * pair of weights of motion that fit, the largest hold. Would catch a sum that grows from frame to frame, and a limit that
 * leaves no room for rounding. */
TEST(pivots_stay_below_their_bound)
{
    static const double holds[] = { 8, 16, 126, 1920, 7936, 15872 };
    fixture_random_t random = { 29 };
    double most = 0;
    for (unsigned round = 0; round < FIXTURE_ROUNDS(2000); round++) {
        make(&random, holds[round % 6], LABIAL_STIFFNESS_MAX, 0, round / 6 % 2);
        walk(&random, round / 12 % 2, 0);
        most = fmax(most, largest_pivot(FRAMES));
    }
    memset(states, 0, sizeof states);
    memset(contact, 0, sizeof contact);
    model.channels[0].contact_weight = 0;
    for (unsigned dd = 0; fixture_weight_value((uint8_t)dd) * 6 + LABIAL_WEIGHT_MIN <= LABIAL_WEIGHT_SUM_MAX; dd++)
        for (unsigned d = 0; d <= dd; d += 1 + d / 16) {
            const double left =
                LABIAL_WEIGHT_SUM_MAX - 6 * fixture_weight_value((uint8_t)dd) - 2 * fixture_weight_value((uint8_t)d);
            if (left < LABIAL_WEIGHT_MIN || not_above(left) < 8 ||
                fixture_weight_value((uint8_t)dd) > LABIAL_STIFFNESS_MAX * fixture_weight_value(not_above(left)))
                continue;
            for (unsigned q = 0; q < STATES; q++) {
                states[q].hold = not_above(left);
                states[q].weight[0] = (uint8_t)d;
                states[q].weight[1] = (uint8_t)dd;
            }
            most = fmax(most, largest_pivot(12));
        }
    assert_true(most > 0.9994);
}

/* All equal: whatever the weights, motion rests exactly where it is held. Would catch a drift of rounding errors. */
TEST(what_rests_stays_at_rest)
{
    fixture_random_t random = { 25 };
    for (unsigned round = 0; round < FIXTURE_ROUNDS(500); round++) {
        const int16_t place = (int16_t)((int)fixture_below(&random, 32767) - LABIAL_POSITION_MAX);
        labial_factors_t factors[FRAMES];
        int16_t motion[FRAMES];
        make(&random, round % 2 ? 126 : 8000, LABIAL_STIFFNESS_MAX, 0, round / 2 % 2);
        walk(&random, 1, 0);
        for (unsigned q = 0; q < STATES; q++)
            states[q].mean = place;
        for (unsigned t = 0; t < FRAMES; t++)
            target[t] = place;
        require_accepted();
        go_forward(FRAMES, FRAMES, factors);
        labial_trajectory_back(factors + FRAMES - 1, 0, FRAMES, FRAMES - 1, FRAMES, motion);
        for (unsigned t = 0; t < FRAMES; t++)
            assert_int_equal(motion[t], place + channel.centre);
    }
}

/* Solutions one after the other, some of a single frame: would catch a backward pass that carries something of the later
 * one into the earlier, and places of the ring of motion that are one off. */
TEST(solutions_are_not_coupled)
{
    fixture_random_t random = { 26 };
    for (unsigned round = 0; round < FIXTURE_ROUNDS(2000); round++) {
        const unsigned first = 1 + fixture_below(&random, 20), second = 1 + fixture_below(&random, 20);
        labial_factors_t factors[FRAMES];
        double wanted[FRAMES];
        int16_t motion[FRAMES];
        make(&random, round % 2 ? 126 : 8000, LABIAL_STIFFNESS_MAX, round % 3 / 2.0, 0);
        walk(&random, 0, round / 2 % 2);
        require_accepted();
        go_forward(first, 3, factors);
        oracle_trajectory(&channel, path, target, contact, 0, gain, first, NULL, wanted);
        walk(&random, 0, 1);
        require_accepted();
        go_forward(second, 3, factors + first);
        labial_trajectory_back(factors + first + second - 1, second, first, round % 7, 7, motion);
        for (unsigned t = 0; t < first && t < 7; t++) /* the earliest seven overwrite the others */
            judge(motion[(round % 7 + 7 - (first - 1 - t) % 7) % 7], wanted[t]);
    }
}

SETUP(setup)
{
    for (unsigned t = 0; t < FRAMES; t++)
        gain[t] = LABIAL_GAIN_ONE;
    fixture_slow(&model);
    return 0;
}

SUITE(setup, NULL)
