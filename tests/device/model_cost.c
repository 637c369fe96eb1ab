/*
 * model_cost.c - labial_model_cost() against instructions that are counted: of the bundled models, and of models that
 * pass every check and yet cost many times as much. Prints a line for each.
 *
 * Would catch a table that costs more than is said, a step of the stream that was made dearer, and an estimate so far
 * above what is counted that it refuses models without need. Where nothing is counted, as on the host, the counts of a
 * Cortex-M0 stand in.
 */
#include "board.h"
#include "laughter_synthetic.h"
#include "speech_en.h"

#define PUSHES 200u /* phonemes of one frame, each unlike the one before it */
#define PHONEMES 3u /* silence and two that follow each other */
#define COMPONENTS 8u
#define PAIRS 8u
#define LEAST_SHARE 45u /* percent of what is said that a Cortex-M0 must take */

/* ---- Tables for the largest model that there can be; smaller ones read less of them ------------------------------ */

#define FOUR(...) __VA_ARGS__ __VA_ARGS__ __VA_ARGS__ __VA_ARGS__
#define SIXTEEN(...) FOUR(__VA_ARGS__) FOUR(__VA_ARGS__) FOUR(__VA_ARGS__) FOUR(__VA_ARGS__)
#define SIXTY_FOUR(...) SIXTEEN(__VA_ARGS__) SIXTEEN(__VA_ARGS__) SIXTEEN(__VA_ARGS__) SIXTEEN(__VA_ARGS__)

#define EMISSION { 0, 0x80, 0 },
#define STATE { 0, { 0, 0 }, 0x20, 128, { 0x11, 0x12 } },
#define COMPONENT { 0, 20, 4096 },

static const labial_emission_t emissions[LABIAL_STATES_MAX] = { SIXTY_FOUR(EMISSION) };
static const labial_state_t states[LABIAL_STATES_MAX] = { SIXTY_FOUR(STATE) };
static const labial_transition_t transitions[LABIAL_STATES_MAX * LABIAL_STATES_MAX] = { { 0, 0 } };
static const labial_component_t components[2 * COMPONENTS] = { SIXTEEN(COMPONENT) };
static const uint8_t initials[LABIAL_STATES_MAX] = { 0 };
static const uint8_t contexts[2 * COMPONENTS * PHONEMES] = { 0 };
static const int8_t shapes[2 * COMPONENTS * LABIAL_CHANNELS] = { 0 }; /* and slopes */
static const uint32_t kernels[PHONEMES * LABIAL_KERNEL_TAPS_MAX * LABIAL_KERNEL_WORDS(LABIAL_CHANNELS)] = { 0 };
static const uint16_t pair_keys[PAIRS] = { 0x100, 0x102, 0x180, 0x182, 0x200, 0x201, 0x280, 0x281 };
static const int8_t pairs[PAIRS * 2 * LABIAL_CHANNELS] = { 0 };
static const int16_t floors[LABIAL_CHANNELS] = { 0 };
static const uint16_t contacts[1] = { 0x1fff };

/* What a model is made of; all have every optional table. */
typedef struct {
    const char *name;
    uint8_t stride, states, fours, taps, components;
    uint32_t counted; /* by this image on the board m0, instructions */
} recipe_t;

static const recipe_t recipes[] = {
    { "many transitions", 3, LABIAL_STATES_MAX, LABIAL_STATES_MAX / 4, 13, 5, 44763 },
    { "a state for each frame", 1, LABIAL_STATES_MAX, 1, 13, 5, 33102 },
    { "a state for eight frames", 8, LABIAL_STATES_MAX, 1, 13, 5, 17477 },
    { "many taps", 3, 8, 1, LABIAL_KERNEL_TAPS_MAX, 1, 19729 },
    { "many components", 3, 8, 1, 1, COMPONENTS, 21301 },
    { "all of it", 1, LABIAL_STATES_MAX, LABIAL_STATES_MAX / 4, LABIAL_KERNEL_TAPS_MAX, COMPONENTS, 97632 },
};

static labial_phoneme_t phonemes[PHONEMES];
static labial_channel_t channels[LABIAL_CHANNELS];
static labial_model_t model;
static labial_t stream;
static uint32_t workspace[LABIAL_WORKSPACE_SIZE(LABIAL_SEARCH_STRIDE_MAX, LABIAL_CHANNELS) / 4];
static int32_t sum;
static int failures;

static void make(const recipe_t *recipe)
{
    for (unsigned k = 0; k < LABIAL_CHANNELS; k++) {
        channels[k].shape_scale = channels[k].slope_scale = channels[k].kernel_scale = channels[k].pair_scale = 256;
        channels[k].contact_weight = 0x20;
        channels[k].emissions = emissions;
        channels[k].states = states;
        channels[k].transitions = transitions;
        channels[k].initials = initials;
    }
    for (unsigned k = 0; k < PHONEMES; k++) {
        phonemes[k].first_component = (uint16_t)(k == 2 ? COMPONENTS : 0);
        phonemes[k].component_count = recipe->components;
        phonemes[k].viseme_class = (uint8_t)k;
        phonemes[k].boundary = 1;
        phonemes[k].floor = k > 0;
    }
    model.format = LABIAL_MODEL_FORMAT;
    model.frames_per_second = 50;
    model.component_count = 2 * COMPONENTS;
    model.phoneme_count = model.class_count = PHONEMES;
    model.state_count = recipe->states;
    model.predecessor_fours = recipe->fours;
    model.search_stride = recipe->stride;
    model.mixture_mean = 1;
    model.kernel_taps = recipe->taps;
    model.kernel_stride = 1;
    model.kernel_behind = recipe->taps / 2u;
    model.floor_count = 1;
    model.pair_knots = 2;
    model.pair_count = PAIRS;
    model.channel_count = LABIAL_CHANNELS;
    for (unsigned k = 0; k < LABIAL_CHANNELS; k++)
        model.sources[k] = (uint8_t)k;
    model.phonemes = phonemes;
    model.components = components;
    model.contexts = contexts;
    model.shapes = model.slopes = shapes;
    model.kernels = kernels;
    model.pair_keys = pair_keys;
    model.pairs = pairs;
    model.floors = floors;
    model.contacts = contacts;
    model.channels = channels;
}

/* ---- Counting ---------------------------------------------------------------------------------------------------- */

static void expect(int holds, const char *what)
{
    if (!holds) {
        board_print("FAILED: ");
        board_print(what);
        board_put('\n');
        failures++;
    }
}

static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    (void)user;
    (void)frame;
    sum += faps[0];
}

/* The dearest tick of a stream of short phonemes, instructions; 0 where nothing is counted. */
static uint32_t counted(const labial_model_t *played)
{
    uint32_t worst = 0, pushed = 0;
    int result = labial_init(&stream, played, workspace, sizeof workspace, on_frame, 0);
    expect(result == LABIAL_OK, "the stream begins");
    while (result >= LABIAL_OK && result != LABIAL_DONE) {
        for (; pushed < PUSHES && labial_room(&stream) > 0; pushed++)
            labial_push(&stream, 1u + pushed % 2u, 20);
        if (pushed == PUSHES)
            labial_end(&stream);
        board_count_start();
        result = labial_tick(&stream);
        const uint32_t taken = board_count();
        worst = taken > worst ? taken : worst;
    }
    expect(result == LABIAL_DONE, "the stream ends");
    return worst;
}

static void judge(const char *name, const labial_model_t *played, uint32_t recorded)
{
    const uint32_t said = labial_model_cost(played), worst = counted(played);
    board_print(name);
    board_print_within(": ", said, " said, ");
    board_print_within("", worst, " counted\n");
    expect(labial_model_check(played) == LABIAL_OK, "the model passes the check");
    expect(worst <= said && recorded <= said, "no tick costs more than is said");
    expect(recorded > said / 100u * LEAST_SHARE, "what is said is not far above what a Cortex-M0 takes");
#if defined(__ARM_ARCH_6M__)
    expect(worst > said / 100u * LEAST_SHARE, "what is said is not far above what is counted");
#endif
}

int main(void)
{
    const uint32_t bundled = labial_model_cost(&speech_en);
    judge("speech", &speech_en, 12936);
    judge("laughter", &laughter_synthetic, 12446);
    for (unsigned i = 0; i < sizeof recipes / sizeof *recipes; i++) {
        make(&recipes[i]);
        judge(recipes[i].name, &model, recipes[i].counted);
    }
    expect(labial_model_cost(&model) > 4u * bundled, "what costs several times as much is told apart");
    expect(labial_model_cost(0) == 0, "no model costs nothing");
    return failures;
}
