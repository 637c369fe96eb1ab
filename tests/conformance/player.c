#include "player.h"

/* Ticks from a frame that is taken up to its delivery; the first ones return LABIAL_WAITING. */
#define DELAY LABIAL_DELAY((unsigned)speech_en.search_stride)

const char *const conformance_feed_names[CONFORMANCE_FEEDS] = { "fill", "single", "hungry", "real time" };

typedef struct {
    labial_t *stream;
    labial_frame_fn sink;
    void *user;
    const char *complaint;
    conformance_feed_t feed;
    unsigned model;
    uint32_t frames;                /* in all */
    uint32_t take;                  /* of them before the part that is played, which labial_restart() began */
    uint32_t cancel_at;             /* frames of the part after which it is cancelled, UINT32_MAX if it ends */
    uint32_t ticks;                 /* of the part */
    uint32_t pushed;                /* milliseconds, of the part */
    unsigned idle;                  /* ticks since the last frame or push */
    int last;                       /* what the tick before returned */
    const conformance_step_t *next; /* a step of the part that sets the articulation, or what follows these */
} player_t;

static void complain(player_t *player, const char *what)
{
    if (!player->complaint)
        player->complaint = what;
}

/* Sets the articulation, if it is to change after as many frames as there are. */
static void articulate(player_t *player)
{
    const conformance_step_t *step = player->next;
    if (step->kind != CONFORMANCE_ARTICULATION || player->frames - player->take != step->value)
        return;
    player->next++;
    if (labial_articulation(player->stream, step->milliseconds) != LABIAL_OK)
        complain(player, "an articulation is refused");
}

static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    player_t *player = (player_t *)user;
    if (frame != player->frames)
        complain(player, "a frame has the wrong number");
    player->frames++;
    player->sink(player->user, frame, faps);
    articulate(player);
}

static int is_cut(const player_t *player)
{
    return player->frames - player->take == player->cancel_at;
}

static void tick(player_t *player)
{
    const uint32_t before = player->frames;
    const int result = labial_tick(player->stream);
    if (result < 0)
        complain(player, "a tick failed");
    if (player->frames != before + (result == LABIAL_OK ? 1u : 0u))
        complain(player, "a tick delivered other than what it said");
    if (result == LABIAL_WAITING && player->last != LABIAL_WAITING)
        complain(player, "a tick waits for a first frame that was delivered");
    player->idle = result == LABIAL_OK ? 0 : player->idle + 1u;
    player->ticks++;
    player->last = result;
}

/* Whether the stream does nothing more before it gets another phoneme: a frame that it took up would have come. */
static int starves(const player_t *player)
{
    return player->last == LABIAL_STARVED || player->idle > DELAY;
}

/* The stream has got what it may have waited for. */
static void feed(player_t *player)
{
    player->idle = 0;
    if (player->last == LABIAL_STARVED)
        player->last = LABIAL_OK;
}

static int goes_on(const player_t *player)
{
    return !player->complaint && !is_cut(player);
}

/* Ticks before a push, as the feed demands, until there is room. */
static void make_room(player_t *player)
{
    if (player->feed == CONFORMANCE_SINGLE)
        tick(player);
    if (player->feed == CONFORMANCE_HUNGRY)
        while (goes_on(player) && !starves(player))
            tick(player);
    if (player->feed == CONFORMANCE_REAL_TIME) /* until the phoneme begins */
        while (goes_on(player) && player->ticks < player->pushed * speech_en.frames_per_second / 1000u)
            tick(player);
    while (goes_on(player) && labial_room(player->stream) == 0) {
        tick(player);
        if (starves(player))
            complain(player, "a full queue does not move the stream");
    }
}

static void push(player_t *player, const conformance_step_t *step)
{
    static const labial_model_t *const models[CONFORMANCE_MODELS] = { &speech_en, &laughter_synthetic };
    if (step->model != player->model && labial_use(player->stream, models[step->model]) != LABIAL_OK)
        complain(player, "a model is refused");
    player->model = step->model;
    if (labial_push(player->stream, step->value, step->milliseconds) != LABIAL_OK)
        complain(player, "a phoneme is refused");
    player->pushed += step->milliseconds;
    feed(player);
}

static void finish(player_t *player, const conformance_step_t *step)
{
    uint32_t left;
    feed(player);
    if (step->kind == CONFORMANCE_AGAIN) {
        for (left = step->value; left > 0 && !player->complaint; left--) {
            tick(player);
            if (player->last != LABIAL_OK)
                complain(player, "an easing is over too early");
        }
        if (labial_cancel(player->stream, step->milliseconds) != LABIAL_OK)
            complain(player, "a second cancel is refused");
    } else if (step->kind == CONFORMANCE_CANCEL) {
        while (!player->complaint && !is_cut(player)) {
            tick(player);
            if (starves(player))
                complain(player, "the frame to cancel after needs phonemes that do not come");
        }
        if (labial_cancel(player->stream, step->milliseconds) != LABIAL_OK)
            complain(player, "a cancel is refused");
    } else if (labial_end(player->stream) != LABIAL_OK || labial_exact(player->stream, 0) != LABIAL_OK) {
        complain(player, "an end is refused");
    }
}

/* Ticks until nothing is left; there is nothing to wait for. */
static void drain(player_t *player)
{
    do {
        tick(player);
        if (player->last != LABIAL_DONE && starves(player))
            complain(player, "a frame is late");
    } while (!player->complaint && player->last != LABIAL_DONE);
}

static void begin_part(player_t *player, const conformance_stream_t *script, unsigned i)
{
    const conformance_step_t *last = &script->steps[i];
    while (last->kind == CONFORMANCE_PUSH || last->kind == CONFORMANCE_ARTICULATION)
        last++;
    player->take = player->frames;
    player->cancel_at = last->kind == CONFORMANCE_CANCEL ? last->value : UINT32_MAX;
    player->ticks = player->pushed = 0;
    player->idle = 0;
    player->last = LABIAL_WAITING;
    player->next = &script->steps[i];
    articulate(player);
}

const char *conformance_play(const conformance_stream_t *script, conformance_feed_t feed, labial_t *stream,
                             void *workspace, size_t workspace_size, labial_frame_fn sink, void *user)
{
    player_t player = { 0 };
    unsigned i;
    player.stream = stream;
    player.sink = sink;
    player.user = user;
    player.feed = feed;
    player.model = CONFORMANCE_SPEECH;
    if (labial_init(stream, &speech_en, workspace, workspace_size, on_frame, &player) != LABIAL_OK)
        return "labial_init() failed";
    (void)labial_exact(stream, 1); /* as long as phonemes are to come: feeds starve it, each in its way */
    begin_part(&player, script, 0);

    for (i = 0; i < script->step_count && !player.complaint; i++) {
        const conformance_step_t *step = &script->steps[i];
        if (step->kind == CONFORMANCE_ARTICULATION)
            continue;
        if (step->kind == CONFORMANCE_PUSH) {
            if (!is_cut(&player))
                make_room(&player);
            /* The phonemes after a cut are never heard of, those before the first frame are as far as there is room. */
            if (!is_cut(&player) || (player.frames == player.take && labial_room(stream) > 0))
                push(&player, step);
            continue;
        }
        finish(&player, step);
        if (i + 1u < script->step_count && step[1].kind == CONFORMANCE_AGAIN)
            continue;
        drain(&player);
        if (player.next->kind == CONFORMANCE_ARTICULATION)
            complain(&player, "an articulation is set after the part's frames");
        if (i + 1u < script->step_count) {
            if (labial_restart(stream) != LABIAL_OK || labial_exact(stream, 1) != LABIAL_OK)
                complain(&player, "a restart is refused");
            begin_part(&player, script, i + 1u);
        }
    }
    return player.complaint;
}

void conformance_digest(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    conformance_digest_t *digest = (conformance_digest_t *)user;
    uint32_t crc = ~digest->crc;
    unsigned i, bit;
    (void)frame;
    for (i = 0; i < 2u * LABIAL_CHANNELS; i++) {
        crc ^= (uint32_t)(uint16_t)faps[i / 2u] >> (8u * (i % 2u)) & 0xffu;
        for (bit = 0; bit < 8; bit++)
            crc = crc >> 1 ^ (0xedb88320u & (0u - (crc & 1u)));
    }
    digest->crc = ~crc;
    digest->frames++;
}
