/*
 * test_soak.c - eight hours of everything that a face runs on, without a new init, each counter's wrap halfway.
 *
 * A stream of phonemes: speech and laughter by chance, starving, cancelled, taken up again. Every frame is accounted for:
 * what was delivered and what the stream still holds are the rounded sum of what was pushed, and frames are numbered on
 * without a gap. Every hour one sentence must give the frames that it gave a stream that was new.
 *
 * Sound that is heard, whose frames move the servos of a face by a clock that stumbles, and whose values are sent to a
 * player of lips beside the audio. The face stays within its limits and in step with the clock; the player shows each
 * frame with its sample.
 *
 * A voice that answers again and again: words ahead of their sound, told twice, too late, and cancelled, by a clock that
 * stumbles. Each moment has its frame, the face rests between answers, and every hour one answer moves it as at first,
 * within 16 FAP units.
 *
 * Nothing beside the structures and their workspaces is ever written to.
 */
#include "suite.h"
#include "drawn.h"
#include "hear_fixture.h"
#include "labial/beside.h"
#include "labial/face.h"
#include "labial/laugh.h"
#include "labial/voice.h"
#include "laughter_synthetic.h"
#include "speech_en.h"
#include "words_en.h"

#define RATE SPEECH_EN_FPS
#define HOUR (3600u * RATE) /* frames */
#define WORKSPACE LABIAL_LARGER(SPEECH_EN_WORKSPACE_SIZE, LAUGHTER_SYNTHETIC_WORKSPACE_SIZE)
#define CANARIES 8
#define FADE 8u       /* frames in which a stream that is taken up again comes from its last pose */
#define SENTENCE 400u /* frames that are kept of it, at most */

#define SERVOS 2
#define AHEAD 5
#define KEPT 64u /* frames that the player's ring and the server remember */
#define PLACES 400

static struct {
    uint32_t before[CANARIES];
    labial_t stream;
    uint32_t between[CANARIES];
    uint32_t workspace[WORKSPACE / 4];
    uint32_t after[CANARIES];
} memory;

static struct {
    uint32_t before[CANARIES];
    labial_hear_t hear;
    uint32_t workspace[HEAR_FIXTURE_WORKSPACE_SIZE / 4];
    uint32_t behind_hear[CANARIES];
    labial_face_t face;
    int32_t room[LABIAL_FACE_SIZE(SERVOS, AHEAD) / 4];
    uint32_t behind_face[CANARIES];
    labial_beside_t player;
    uint8_t ring[LABIAL_BESIDE_SIZE(SERVOS, KEPT)];
    uint32_t behind_player[CANARIES];
} toy;

static struct {
    uint32_t before[CANARIES];
    labial_voice_t voice;
    uint32_t between[CANARIES];
    uint32_t memory[LABIAL_VOICE_SIZE(3, 8, PLACES) / 4];
    uint32_t after[CANARIES];
} agent;

/* Paints what lies beside the structures and their workspaces, or checks that nothing was written there. */
static void guard(int check)
{
    static uint32_t *const places[] = { memory.before,   memory.between,  memory.after,      toy.before,
                                        toy.behind_hear, toy.behind_face, toy.behind_player, agent.before,
                                        agent.between,   agent.after };
    for (unsigned i = 0; i < COUNT_OF(places) * CANARIES; i++) {
        uint32_t *const word = &places[i / CANARIES][i % CANARIES];
        if (check)
            assert_int_equal(*word, (i + 1u) * 0x9e3779b1u);
        *word = (i + 1u) * 0x9e3779b1u;
    }
}

typedef struct {
    fixture_random_t random;
    labial_laugh_t laugh;
    unsigned phonemes; /* of speech that are still to be said before something else is chosen */
    int laughing;
    uint32_t next;       /* number of the frame that is due */
    unsigned calls;      /* of the callback, since the last tick began */
    uint64_t day;        /* frames since midnight */
    uint64_t ms, frames; /* pushed and delivered since the stream began or was taken up again */
    unsigned ends, cancels, laughs, starved, wraps;
    int16_t (*kept)[LABIAL_CHANNELS]; /* where frames go, or null */
} day_t;

static day_t day;

static const labial_model_t *const models[] = { &speech_en, &laughter_synthetic };

static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    day_t *d = (day_t *)user;
    assert_int_equal(frame, d->next);
    for (unsigned c = 0; c < LABIAL_CHANNELS; c++)
        assert_in_range(faps[c], -1500, 1500);
    if (d->kept && d->frames < SENTENCE)
        memcpy(d->kept[d->frames], faps, sizeof d->kept[0]);
    d->next++;
    d->wraps += d->next == 0;
    d->calls++;
    d->frames++;
    d->day++;
}

static void begin_day(uint32_t first)
{
    memset(&day, 0, sizeof day);
    guard(0);
    assert_ok(labial_init(&memory.stream, &speech_en, memory.workspace, WORKSPACE, on_frame, &day));
    assert_ok(labial_exact(&memory.stream, 1));
    day.random.state = 20;
    memory.stream.frame = day.next = first; /* no day is long enough to come there otherwise */
}

/* Frames that are pushed and not delivered: the rounded sum of the durations less what came. */
static uint64_t held(void)
{
    return (day.ms * RATE + 500u) / 1000u - day.frames;
}

static int tick(void)
{
    day.calls = 0;
    const int result = labial_tick(&memory.stream);
    assert_in_range(result, LABIAL_OK, LABIAL_DONE);
    assert_int_equal(day.calls, result == LABIAL_OK);
    guard(1);
    return result;
}

static void push(unsigned phoneme, uint32_t ms)
{
    assert_ok(labial_push(&memory.stream, phoneme, ms));
    day.ms += ms;
}

/* Goes on with what is being said or laughed by one phoneme, or begins something new. */
static void feed(void)
{
    unsigned phoneme;
    uint32_t ms;
    if (day.laughing) {
        if (labial_laugh_next(&day.laugh, &phoneme, &ms) == LABIAL_OK)
            push(phoneme, ms);
        else
            day.laughing = 0;
        return;
    }
    if (day.phonemes == 0) {
        day.laughing = fixture_below(&day.random, 3) == 0;
        assert_ok(labial_use(&memory.stream, models[day.laughing]));
        day.phonemes = day.laughing ? 0 : 1u + fixture_below(&day.random, 60);
        day.laughs += (unsigned)day.laughing;
        if (day.laughing)
            assert_ok(labial_laugh_init(&day.laugh, fixture_below(&day.random, 6000),
                                        fixture_below(&day.random, LABIAL_LAUGH_FULL + 1u),
                                        fixture_random(&day.random)));
        return;
    }
    day.phonemes--;
    ms = fixture_below(&day.random, 240);
    phoneme = fixture_below(&day.random, SPEECH_EN_PHONEMES);
    if (fixture_below(&day.random, 20) == 0) {
        phoneme = SPEECH_EN_SIL;
        ms = fixture_below(&day.random, 20000);
    } else if (fixture_below(&day.random, 20) == 0) {
        ms = fixture_below(&day.random, 3);
    }
    push(phoneme, ms);
}

static void restart(void)
{
    assert_ok(labial_restart(&memory.stream));
    day.ms = day.frames = 0;
    day.phonemes = 0;
    day.laughing = 0;
}

/* Plays what is held to its last frame. */
static void end(void)
{
    uint64_t ticks = held() + labial_latency(&memory.stream).delay;
    assert_ok(labial_end(&memory.stream));
    while (tick() != LABIAL_DONE)
        assert_true(ticks-- > 0);
    assert_true(held() == 0);
    day.ends++;
    restart();
}

static uint64_t ease_frames(uint32_t ms)
{
    const uint64_t frames = ((uint64_t)ms * RATE + 999u) / 1000u;
    return frames < 1u ? 1u : frames < 1000u ? frames : 1000u;
}

/* Cancels, sometimes twice, and eases to the neutral face. */
static void cancel(void)
{
    uint32_t ms = fixture_below(&day.random, 600);
    uint64_t left = ease_frames(ms);
    assert_ok(labial_cancel(&memory.stream, ms));
    if (fixture_below(&day.random, 3) == 0) {
        assert_ok(tick());
        ms = fixture_below(&day.random, 600);
        left = ease_frames(ms);
        assert_ok(labial_cancel(&memory.stream, ms));
    }
    for (; left > 0; left--)
        assert_ok(tick());
    assert_int_equal(tick(), LABIAL_DONE);
    day.cancels++;
    restart();
}

/* A sentence and a laugh, after everything else has ended; returns the frames. */
static size_t speak(int16_t kept[SENTENCE][LABIAL_CHANNELS])
{
    day.kept = kept;
    assert_ok(labial_use(&memory.stream, &speech_en));
    for (unsigned i = 0; i < 20; i++)
        push((i * 7u + 3u) % SPEECH_EN_PHONEMES, 60u + i % 5u * 20u);
    assert_ok(labial_use(&memory.stream, &laughter_synthetic));
    for (unsigned i = 0; i < 10; i++)
        push(i % LABIAL_LAUGH_PHONEMES, 110);
    assert_ok(labial_end(&memory.stream));
    while (tick() != LABIAL_DONE) {
    }
    const size_t frames = (size_t)day.frames;
    day.kept = NULL;
    restart();
    return frames;
}

/* Would catch a frame lost or doubled in any of what a day brings, state that decays, and any write beside the memory. */
TEST(a_day_is_exact_to_the_frame)
{
    static int16_t first[SENTENCE][LABIAL_CHANNELS], again[SENTENCE][LABIAL_CHANNELS];
    const uint64_t length = (uint64_t)FIXTURE_ROUNDS(8 * 60) * (HOUR / 60u);
    unsigned sentences = 0;
    begin_day(0u - (uint32_t)(length / 2u));
    const size_t frames = speak(first);
    assert_in_range(frames, FADE + 1u, SENTENCE);
    while (day.day < length) {
        const uint32_t chance = fixture_below(&day.random, 4096);
        unsigned burst = fixture_below(&day.random, 8) == 0 ? fixture_below(&day.random, 40) : 0;
        if (day.day / HOUR > sentences || (chance == 0 && day.day < HOUR)) {
            sentences += chance != 0;
            end();
            assert_int_equal(speak(again), frames);
            assert_memory_equal(again[FADE], first[FADE], (frames - FADE) * sizeof first[0]);
        } else if (chance < 4) {
            end();
        } else if (chance < 8) {
            cancel();
        }
        for (; burst > 0 && labial_room(&memory.stream) > 0; burst--)
            feed();
        const int result = tick();
        assert_int_not_equal(result, LABIAL_DONE);
        day.starved += result == LABIAL_STARVED;
        assert_true(labial_latency(&memory.stream).frames == held());
    }
    end();
    assert_int_equal(day.wraps, 1);
    assert_true(day.ends > length / 4096u && day.cancels > length / 4096u / 2u);
    assert_true(day.laughs > length / 4096u && day.starved > 0);
}

/* Would catch a frame number that is taken for the count of frames: restarted at number 0, a face that is not neutral
 * would jump. */
TEST(a_restart_at_the_wrap_does_not_jump)
{
    static int16_t before[SENTENCE][LABIAL_CHANNELS], after[SENTENCE][LABIAL_CHANNELS];
    unsigned frames = 10;
    int moved = 0;
    begin_day(0u - frames);
    day.kept = before;
    push(SPEECH_EN_AA, frames * 1000u / RATE);
    end();
    assert_int_equal(day.next, 0);
    day.kept = after;
    push(SPEECH_EN_UW, 1000);
    end();
    assert_int_equal(day.next, RATE);
    for (unsigned c = 0; c < LABIAL_CHANNELS; c++) {
        const int step = after[0][c] - before[frames - 1u][c], whole = after[FADE][c] - before[frames - 1u][c];
        moved |= whole > 40 || whole < -40;
        assert_true(step * 4 <= (whole < 0 ? -whole : whole) + 40 && -step * 4 <= (whole < 0 ? -whole : whole) + 40);
    }
    assert_true(moved);
}

/* ---- Sound, servos and lips beside the audio ----------------------------------------------------------------------- */

#define SOUND_RATE 8000u
#define SAMPLES (SOUND_RATE / LABIAL_HEAR_FPS) /* of a frame */
#define BUFFERED 32                            /* frames that the server is ahead of what is heard */
#define REPEATED 8u                            /* frames of a packet */

static labial_rig_output_t servos[SERVOS] = { [1] = { .weights = { [5] = LABIAL_RIG_ONE },
                                                      .gain = LABIAL_RIG_GAIN(2, 1),
                                                      .neutral = 90,
                                                      .minimum = 20,
                                                      .maximum = 160,
                                                      .slew = 25 } };
static const labial_rig_t rig = { servos, SERVOS };

static struct {
    fixture_random_t random;
    uint32_t heard, told;             /* numbers of the frame and of the class that are due */
    int16_t (*kept)[LABIAL_CHANNELS]; /* where frames go, or null */
    size_t frames;                    /* since the sound began */
    uint32_t at, state;               /* of the sound that is made */
    int32_t values[SERVOS], changes[SERVOS];
    unsigned steady; /* ticks since the clock stumbled */
    uint32_t frame;  /* that the server sends next */
    uint32_t known;  /* the first frame that the player must show */
    uint16_t session;
    uint8_t sent[KEPT][SERVOS];
    unsigned lost, cancels, wraps;
} shift;

static void on_heard(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    assert_int_equal(frame, shift.heard++);
    shift.wraps += shift.heard == 0;
    if (shift.kept && shift.frames < SENTENCE)
        memcpy(shift.kept[shift.frames], faps, sizeof shift.kept[0]);
    shift.frames++;
    labial_face_frame(user, frame, faps);
}

static void on_class(void *user, unsigned shown, uint32_t frame, uint32_t frames)
{
    (void)user;
    assert_in_range(shown, 0, HEAR_FIXTURE_CLASSES - 1);
    assert_true(frames > 0);
    assert_int_equal(frame, shift.told);
    shift.told += frames;
}

static void begin_shift(uint32_t first)
{
    memset(&toy, 0, sizeof toy);
    memset(&shift, 0, sizeof shift);
    guard(0);
    shift.random.state = 36;
    servos[0] = fixture_jaw(1900, 60, 20);
    assert_ok(labial_rig_check(&rig));
    assert_ok(labial_face_init(&toy.face, &rig, LABIAL_HEAR_FPS, AHEAD, toy.room, sizeof toy.room));
    assert_ok(labial_hear_init(&toy.hear, &hear_fixture, SOUND_RATE, 1, toy.workspace, sizeof toy.workspace, on_heard,
                               &toy.face));
    assert_ok(labial_hear_classes(&toy.hear, on_class));
    assert_ok(labial_beside_init(&toy.player, SERVOS, SOUND_RATE, toy.ring, sizeof toy.ring));
    for (unsigned i = 0; i < SERVOS; i++)
        shift.values[i] = servos[i].neutral;
    toy.hear.frame = toy.hear.first = shift.heard = shift.told = first;
}

/* Pushes a frame of sound: some seconds of speech, noise or silence, then others. */
static void hear_frame(void)
{
    int16_t samples[SAMPLES];
    for (unsigned i = 0; i < SAMPLES; i++, shift.at++)
        samples[i] = hear_sound(3u + shift.at / 24000u % 5u, shift.at, &shift.state);
    assert_ok(labial_hear_push(&toy.hear, samples, SAMPLES));
}

/* A sound of its own, as long as a sentence; returns its frames. */
static size_t hear_sentence(int16_t kept[SENTENCE][LABIAL_CHANNELS])
{
    assert_ok(labial_hear_set_level(&toy.hear, LABIAL_HEAR_LEVEL_BEGIN));
    shift.kept = kept;
    shift.frames = 0;
    shift.at = 0;
    shift.state = 1;
    for (unsigned i = 0; i < SENTENCE - 20u; i++)
        hear_frame();
    assert_ok(labial_hear_end(&toy.hear));
    assert_int_equal(shift.told, shift.heard - (uint32_t)(shift.frames - (SENTENCE - 20u)));
    shift.kept = NULL;
    return shift.frames;
}

/* A tick of the face, which keeps its limits. */
static int move_servos(void)
{
    int32_t values[SERVOS];
    const int result = labial_face_tick(&toy.face, values);
    assert_in_range(result, LABIAL_OK, LABIAL_DONE);
    for (unsigned i = 0; i < SERVOS; i++) {
        const labial_rig_output_t *const servo = &servos[i];
        const int32_t change = values[i] - shift.values[i];
        assert_in_range(values[i], servo->minimum, servo->maximum);
        assert_in_range(change, -servo->slew, servo->slew);
        if (servo->acceleration > 0 && shift.steady > 2)
            assert_in_range(change - shift.changes[i], -servo->acceleration, servo->acceleration);
        shift.values[i] = values[i];
        shift.changes[i] = change;
    }
    return result;
}

/* Sends `count` frames up to the next one, which it makes void if it cancels, and returns what the player says. */
static int send_frames(unsigned count, int cancels)
{
    uint8_t packet[LABIAL_BESIDE_HEAD + (REPEATED + 1u) * SERVOS] = { LABIAL_BESIDE_FORMAT, (uint8_t)cancels, SERVOS,
                                                                      (uint8_t)count };
    uint8_t *to = packet + 4;
    const uint32_t first = shift.frame - count;
    for (unsigned i = 0; i < 4; i++)
        *to++ = (uint8_t)(first >> 8 * i);
    *to++ = (uint8_t)shift.session;
    *to++ = (uint8_t)(shift.session >> 8);
    to += SERVOS;
    for (unsigned k = 0; k < count; k++, to += SERVOS)
        memcpy(to, shift.sent[(first + k) % KEPT], SERVOS);
    return labial_beside_push(&toy.player, packet, (size_t)(to - packet));
}

/* The server begins anew, with numbers that wrap halfway through the hour. */
static void begin_numbers(uint32_t frame)
{
    shift.session++;
    shift.frame = shift.known = frame;
    assert_int_equal(send_frames(0, 0), shift.session > 1 ? LABIAL_NEW_SESSION : LABIAL_OK);
}

/* The values of the servos go to the player, nine packets of ten arrive, and it shows what is heard now. */
static void play_beside(void)
{
    uint8_t values[SERVOS];
    const uint32_t heard = shift.frame - BUFFERED;
    for (unsigned i = 0; i < SERVOS; i++)
        shift.sent[shift.frame % KEPT][i] = (uint8_t)(shift.values[i] & 0xff);
    shift.frame++;
    if (fixture_below(&shift.random, 10) > 0)
        assert_ok(send_frames(shift.frame - shift.known < REPEATED ? shift.frame - shift.known : REPEATED, 0));
    else
        shift.lost++;
    const int result = labial_beside_tick(&toy.player, heard * SAMPLES + fixture_below(&shift.random, SAMPLES), values);
    if (heard - shift.known < 0x80000000u) {
        assert_ok(result);
        assert_memory_equal(values, shift.sent[heard % KEPT], SERVOS);
    }
}

/* Speech is interrupted: what was not delivered is dropped everywhere. */
static void interrupt(void)
{
    const uint32_t ms = fixture_below(&shift.random, 600);
    assert_ok(labial_hear_cancel(&toy.hear, ms));
    shift.told = shift.heard;
    assert_ok(labial_hear_restart(&toy.hear));
    assert_ok(labial_face_cancel(&toy.face, ms));
    assert_int_equal(send_frames(0, 1), LABIAL_CANCELLED);
    shift.known = shift.frame;
    shift.cancels++;
}

/* The sound ends, the face comes to rest, exactly, and the same sound as at first gives the same frames. */
static void compare_sentence(int16_t first[SENTENCE][LABIAL_CHANNELS], size_t frames)
{
    static int16_t again[SENTENCE][LABIAL_CHANNELS];
    unsigned ticks = 0;
    assert_ok(labial_hear_end(&toy.hear));
    while (move_servos() != LABIAL_DONE)
        assert_true(++ticks < AHEAD + LABIAL_FACE_HOLD + LABIAL_FACE_EASE + LABIAL_FACE_TRAVEL(500, 60, 20));
    assert_int_equal(shift.values[0], 1400);
    assert_int_equal(shift.values[1], 90);
    shift.told = shift.heard; /* the way to rest has no class */
    assert_ok(labial_hear_restart(&toy.hear));
    assert_int_equal(hear_sentence(again), frames);
    assert_memory_equal(again, first, frames * sizeof first[0]);
    shift.told = shift.heard;
    assert_ok(labial_hear_restart(&toy.hear));
}

/* Some hours from a time of the clock and from the number of a frame on. */
static void work(unsigned minutes, uint32_t now, uint32_t frame)
{
    static int16_t first[SENTENCE][LABIAL_CHANNELS];
    const uint32_t length = minutes * 60000u;
    uint32_t passed = 0, ticks = 0, hours = 0;
    begin_shift(frame);
    const size_t frames = hear_sentence(first);
    assert_in_range(frames, SENTENCE - 20, SENTENCE);
    shift.told = shift.heard;
    assert_ok(labial_hear_restart(&toy.hear));
    begin_numbers(0u - HOUR / 2u);
    while (passed < length) {
        const uint32_t chance = fixture_below(&shift.random, 4096);
        const uint32_t step = chance < 16   ? fixture_below(&shift.random, LABIAL_FACE_CATCH_UP)
                              : chance < 80 ? fixture_below(&shift.random, 40)
                                            : 20u;
        shift.steady = step == 20u ? shift.steady + 1u : 0u;
        passed += step;
        for (; labial_face_due(&toy.face, now + passed); ticks++) {
            hear_frame();
            move_servos();
            play_beside();
        }
        assert_in_range(ticks, (uint64_t)passed * LABIAL_HEAR_FPS / 1000u,
                        (uint64_t)(passed + 1u) * LABIAL_HEAR_FPS / 1000u + 1u);
        if (chance == 99)
            interrupt();
        if (passed / 3600000u > hours) {
            hours++;
            compare_sentence(first, frames);
            begin_numbers((hours % 2u ? 0x80000000u : 0u) - HOUR / 2u);
        }
        guard(1);
    }
    compare_sentence(first, frames);
    assert_int_equal(shift.wraps, frame > 0x80000000u);
    assert_true(shift.cancels > length / 20u / 4096u / 4u && shift.lost > length / 20u / 12u);
}

/* Would catch a level, a memory or a fade that decays, times and numbers that are wrong where they wrap, a face that
 * falls behind its clock or leaves its limits, and a frame that the player shows too early, too late or not at all. */
TEST(hours_of_sound_stay_in_step)
{
    const unsigned minutes = FIXTURE_ROUNDS(8 * 60);
    work(minutes, 0u - minutes * 30000u, 0u - minutes * HOUR / 120u);
}

/* The same where counters become negative as signed numbers. */
TEST(sound_stays_in_step_at_half_of_the_counters)
{
    const unsigned minutes = FIXTURE_ROUNDS(60);
    work(minutes, 0x80000000u - minutes * 30000u, 0x80000000u - minutes * HOUR / 120u);
}

/* ---- A voice that is followed ------------------------------------------------------------------------------------ */

#define WORDS 24u   /* of an answer, at most */
#define ANSWER 300u /* frames that are kept of one */
#define PAUSE 40    /* FAP units that a pause is away from the neutral face, at most */

static struct {
    fixture_random_t random;
    uint64_t now;                     /* milliseconds */
    uint64_t due;                     /* the frame that comes next */
    uint32_t answers, identity;       /* how many there were; that of the present one */
    uint32_t ends[WORDS];             /* of its words, milliseconds from its beginning */
    unsigned words, told;             /* how many it has, and how many the voice knows */
    uint64_t begins;                  /* when it does */
    int16_t (*kept)[LABIAL_CHANNELS]; /* where frames go, or null */
    unsigned frames, moved;           /* that were kept; that moved since the answer began */
    unsigned cancels, twice;
} talk;

static const char *const vocabulary[] = { "maybe", "people", "Bob",      "water", "five",
                                          "of",    "a",      "movement", "shoe",  "the" };

/* Tells the words of an answer from one on, up to another. */
static int tell_words(uint32_t identity, unsigned from, unsigned until)
{
    labial_voice_item_t items[WORDS];
    labial_voice_message_t message = { .items = items, .utterance = identity, .kind = LABIAL_VOICE_WORDS };
    memset(items, 0, sizeof items);
    for (unsigned i = from; i < until; i++) {
        labial_voice_item_t *const one = &items[message.count++];
        one->text = vocabulary[(i * 7u + 3u) % (COUNT_OF(vocabulary))];
        one->size = (uint16_t)strlen(one->text);
        one->start = (uint64_t)(i > 0 ? talk.ends[i - 1u] : 100u) * 1000u;
        one->end = (uint64_t)talk.ends[i] * 1000u;
    }
    return labial_voice_tell(&agent.voice, &message);
}

/* The frames that are due, of which none is left out unless the clock jumped by more than a second. */
static void follow(uint32_t milliseconds)
{
    int16_t faps[LABIAL_CHANNELS];
    uint32_t frame;
    talk.now += milliseconds;
    while (labial_voice_next(&agent.voice, talk.now, &frame, faps) == LABIAL_OK) {
        int moves = 0;
        assert_int_equal(frame, milliseconds > 1000u ? talk.now * RATE / 1000u : talk.due);
        talk.due = (uint64_t)frame + 1u;
        for (unsigned c = 0; c < LABIAL_CHANNELS; c++) {
            assert_in_range(faps[c], -1500, 1500);
            moves |= faps[c] > 60 || faps[c] < -60;
        }
        talk.moved += (unsigned)moves;
        if (talk.kept && talk.frames < ANSWER)
            memcpy(talk.kept[talk.frames++], faps, sizeof faps);
    }
    assert_int_equal(talk.due, talk.now * RATE / 1000u + 1u);
    guard(1);
}

/* An answer of words of these lengths, with the next frame. */
static void begin_answer(unsigned words, uint32_t shortest, uint32_t longest)
{
    char name[12];
    uint32_t end = 100;
    const int size = snprintf(name, sizeof name, "%lu", (unsigned long)talk.answers++);
    talk.identity = labial_voice_identity(name, (size_t)size);
    talk.begins = (talk.now / 20u + 1u) * 20u;
    talk.words = words;
    talk.told = talk.moved = 0;
    for (unsigned i = 0; i < words; i++)
        talk.ends[i] = end +=
            shortest + (longest > shortest ? fixture_below(&talk.random, longest - shortest) : i % 5u * 60u);
    assert_ok(labial_voice_begin(&agent.voice, talk.begins, talk.identity));
}

/* Waits until nothing moves, and a while longer, in which the face is at rest. */
static void come_to_rest(void)
{
    static int16_t rest[ANSWER][LABIAL_CHANNELS];
    unsigned waits = 0;
    while (!labial_voice_done(&agent.voice)) {
        assert_true(++waits < 1000u);
        follow(20);
    }
    talk.kept = rest;
    talk.frames = 0;
    for (unsigned i = 0; i < 10u; i++)
        follow(20);
    talk.kept = NULL;
    for (unsigned i = 0; i < talk.frames; i++)
        for (unsigned c = 0; c < LABIAL_CHANNELS; c++)
            assert_in_range(rest[i][c], -PAUSE, PAUSE);
}

/* One answer, from rest to rest; returns its frames. */
static unsigned answer(int16_t kept[ANSWER][LABIAL_CHANNELS])
{
    memset(kept, 0, ANSWER * sizeof kept[0]);
    follow((uint32_t)(1000u - talk.now % 1000u)); /* streams are made from whole seconds on */
    begin_answer(12, 120, 0);
    assert_ok(tell_words(talk.identity, 0, talk.words));
    assert_ok(labial_voice_finish(&agent.voice));
    talk.kept = kept;
    talk.frames = 0;
    for (unsigned i = 0; i < ANSWER; i++)
        follow(20);
    talk.kept = NULL;
    assert_true(talk.moved > 50u);
    const unsigned frames = talk.frames; /* those of the rest are counted anew */
    come_to_rest();
    return frames;
}

/* Goes on with the answer by one step: more of it becomes known, again or too late, it ends, or it is cancelled. */
static void go_on(void)
{
    const uint32_t chance = fixture_below(&talk.random, 64), before = talk.identity;
    unsigned more = talk.told + 1u + fixture_below(&talk.random, 4);
    if (chance == 0) {
        assert_ok(labial_voice_cancel(&agent.voice, fixture_below(&talk.random, 600)));
        come_to_rest();
        assert_int_equal(tell_words(before, talk.told, talk.words), LABIAL_CANCELLED);
        talk.words = 0;
        talk.cancels++;
        return;
    }
    more = more < talk.words ? more : talk.words;
    assert_ok(tell_words(talk.identity, talk.told, more));
    if (chance < 8) {
        assert_ok(tell_words(talk.identity, talk.told, more));
        talk.twice++;
    }
    talk.told = more;
    if (talk.told < talk.words)
        return;
    if (chance < 32)
        assert_ok(labial_voice_finish(&agent.voice));
    while (talk.now < talk.begins + talk.ends[talk.words - 1u] + LABIAL_VOICE_REST)
        follow(20);
    assert_true(talk.moved > 0);
    talk.words = 0;
}

/* Would catch messages that are forgotten too early or never, a motion that depends on what was long ago, times that are
 * wrong where they wrap, and a mouth that stays open between answers. */
TEST(answers_go_on_for_hours)
{
    static int16_t first[ANSWER][LABIAL_CHANNELS], again[ANSWER][LABIAL_CHANNELS];
    const uint64_t length = (uint64_t)FIXTURE_ROUNDS(8 * 60) * 60000u;
    unsigned hours = 0;
    uint64_t begin;
    memset(&agent, 0, sizeof agent);
    memset(&talk, 0, sizeof talk);
    guard(0);
    talk.random.state = 34;
    assert_ok(labial_voice_init(&agent.voice, &speech_en, agent.memory, sizeof agent.memory));
    assert_ok(labial_voice_words(&agent.voice, &words_en, NULL));
    agent.voice.serial = 0u - 1000u; /* no day has so many answers */
    begin = ((UINT64_C(1) << 32) - length / 2u) / 20u * 20u;
    follow((uint32_t)begin);
    (void)answer(first); /* from the neutral face; all others from a pause */
    const unsigned frames = answer(first);
    assert_int_equal(frames, ANSWER);
    while (talk.now < begin + length) {
        if (talk.words == 0)
            begin_answer(1u + fixture_below(&talk.random, WORDS), 60, 500);
        go_on();
        for (unsigned wait = fixture_below(&talk.random, 30); wait > 0; wait--)
            follow(fixture_below(&talk.random, 8) == 0 ? fixture_below(&talk.random, 300) : 20u);
        if ((talk.now - begin) / 3600000u > hours && talk.words == 0) {
            hours++;
            assert_ok(labial_voice_finish(&agent.voice));
            come_to_rest();
            assert_int_equal(answer(again), frames);
            for (unsigned i = 0; i < frames; i++) /* streams from another second on search a little otherwise */
                for (unsigned c = 0; c < LABIAL_CHANNELS; c++)
                    assert_in_range(again[i][c] - first[i][c], -16, 16);
        }
    }
    assert_true(talk.now > UINT64_C(1) << 32 && talk.answers > length / 30000u);
    assert_true(talk.cancels > length / 600000u && talk.twice > length / 600000u);
}

SUITE(NULL, NULL)
