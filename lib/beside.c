/*
 * beside.c - a ring of frames that were sent beside their sound (labial/beside.h).
 *
 * The ring holds the frames now .. now + frames - 1, frame k at k modulo `frames`. Before the values of each stands a
 * mark. When `now` moves on, the marks behind it are cleared, so that a marked place always holds the one frame of the
 * window that belongs there, however often numbers wrap.
 */
#include "labial/beside.h"

#include <string.h>

#define NUMBERS_HALF UINT32_C(0x80000000) /* differences from here on are negative */

/* The most samples per second: times LABIAL_BESIDE_FPS they have 32 bits. */
#define SAMPLE_RATE_MOST UINT32_C(50000000)

#define BESIDE_FRAME_MS (1000u / LABIAL_BESIDE_FPS)

/* Marks. */
#define MARK_EMPTY 0u
#define MARK_WAITS 1u
#define MARK_SHOWN 2u

/* Values of `known`. */
#define KNOWN_REST 1u
#define KNOWN_SESSION 2u

/* Calls without a frame when the face goes to rest. */
#define QUIET_MOST (LABIAL_BESIDE_HOLD + 1)

/* The place of a frame: its mark, then its values. */
static uint8_t *beside_place(const labial_beside_t *player, uint32_t frame)
{
    const size_t at = (size_t)(frame & (player->frames - 1u));
    return player->memory + (size_t)player->outputs * 4u + at * (player->outputs + 1u);
}

/* Moves the window to another first frame, which is not before the current one unless all frames are dropped. */
static void move_window(labial_beside_t *player, uint32_t to, uint32_t dropped)
{
    uint32_t i;
    if (dropped > player->frames)
        dropped = player->frames;
    for (i = 0; i < dropped; i++)
        *beside_place(player, player->now + i) = MARK_EMPTY;
    player->now = to;
}

/* The frame that is heard with a sample. The reference moves by whole seconds, in which samples and frames agree. */
static uint32_t beside_frame(labial_beside_t *player, uint32_t sample)
{
    const uint32_t ahead = sample - player->sample;
    uint32_t seconds = ahead / player->samples_per_second;
    if (ahead >= NUMBERS_HALF)
        seconds = 0u - ((0u - ahead) / player->samples_per_second + 1u);
    player->sample += seconds * player->samples_per_second;
    player->frame += seconds * LABIAL_BESIDE_FPS;
    return player->frame + (sample - player->sample) * LABIAL_BESIDE_FPS / player->samples_per_second;
}

/* The value a step nearer to another one, where it arrives in `left` steps of at most `most` each. */
static uint8_t nearer(uint8_t value, uint8_t to, unsigned left, unsigned most)
{
    unsigned way = to < value ? (unsigned)value - to : (unsigned)to - value;
    if (left > 1u)
        way /= left;
    if (way > most)
        way = most;
    return (uint8_t)(to < value ? value - way : value + way);
}

/* Drops all frames; the face goes to rest without a hold. */
static void drop_frames(labial_beside_t *player)
{
    move_window(player, player->now, player->frames);
    if (player->quiet < LABIAL_BESIDE_HOLD)
        player->quiet = LABIAL_BESIDE_HOLD;
}

/* Drops all frames; numbers begin where second `second` of a session does, with its frame `now`. */
static void begin_session(labial_beside_t *player, uint32_t second, uint32_t now)
{
    drop_frames(player);
    player->sample = second * player->samples_per_second;
    player->frame = second * LABIAL_BESIDE_FPS;
    player->now = now;
}

int labial_beside_init(labial_beside_t *player, unsigned outputs, uint32_t samples_per_second, void *memory,
                       size_t size)
{
    size_t room;
    if (!player || !memory)
        return LABIAL_ERROR_NULL;
    memset(player, 0, sizeof *player);
    if (outputs == 0 || outputs > 255u)
        return LABIAL_ERROR_RANGE;
    if (samples_per_second == 0 || samples_per_second > SAMPLE_RATE_MOST)
        return LABIAL_ERROR_SAMPLE_RATE;
    if (size < LABIAL_BESIDE_SIZE(outputs, 1u))
        return LABIAL_ERROR_WORKSPACE;
    room = (size - LABIAL_BESIDE_SIZE(outputs, 0u)) / (outputs + 1u);
    player->frames = 1;
    while (player->frames < LABIAL_BESIDE_FRAMES_MAX && player->frames <= room / 2u)
        player->frames = (uint16_t)(player->frames * 2u);
    player->outputs = (uint8_t)outputs;
    player->samples_per_second = samples_per_second;
    player->quiet = QUIET_MOST;
    player->left = 1;
    player->memory = (uint8_t *)memory;
    memset(memory, 0, size);
    memset(player->memory + outputs * 3u, 255, outputs);
    return LABIAL_OK;
}

int labial_beside_limit(labial_beside_t *player, unsigned output, unsigned most)
{
    if (!player)
        return LABIAL_ERROR_NULL;
    if (player->outputs == 0)
        return LABIAL_ERROR_STATE;
    if (output >= player->outputs || most == 0 || most > 255u)
        return LABIAL_ERROR_RANGE;
    player->memory[player->outputs * 3u + output] = (uint8_t)most;
    return LABIAL_OK;
}

int labial_beside_restart(labial_beside_t *player, uint32_t samples_per_second)
{
    if (!player)
        return LABIAL_ERROR_NULL;
    if (player->outputs == 0)
        return LABIAL_ERROR_STATE;
    if (samples_per_second == 0 || samples_per_second > SAMPLE_RATE_MOST)
        return LABIAL_ERROR_SAMPLE_RATE;
    player->samples_per_second = samples_per_second;
    player->known &= KNOWN_REST;
    begin_session(player, 0, 0);
    return LABIAL_OK;
}

int labial_beside_push(labial_beside_t *player, const void *packet, size_t size)
{
    const uint8_t *from = (const uint8_t *)packet;
    int result = LABIAL_OK;
    uint16_t session;
    uint32_t frame;
    unsigned k;
    if (!player || !from)
        return LABIAL_ERROR_NULL;
    if (player->outputs == 0)
        return LABIAL_ERROR_STATE;
    if (size < LABIAL_BESIDE_HEAD || from[0] != LABIAL_BESIDE_FORMAT || from[1] > 1u || from[2] != player->outputs ||
        size != LABIAL_BESIDE_HEAD + (from[3] + 1ul) * player->outputs)
        return LABIAL_ERROR_PACKET;
    frame = from[4] | (uint32_t)from[5] << 8 | (uint32_t)from[6] << 16 | (uint32_t)from[7] << 24;
    session = (uint16_t)(from[8] | (unsigned)from[9] << 8);
    if (from[1])
        result = LABIAL_CANCELLED;
    if (!(player->known & KNOWN_SESSION) || session != player->session) {
        if (player->known & KNOWN_SESSION)
            result = LABIAL_NEW_SESSION;
        begin_session(player, frame / LABIAL_BESIDE_FPS, frame);
    } else if (from[1]) {
        drop_frames(player);
        if (frame - player->now < NUMBERS_HALF)
            player->now = frame;
    }
    if (!player->known)
        memcpy(player->memory + player->outputs, from + LABIAL_BESIDE_HEAD, player->outputs);
    player->known = KNOWN_REST | KNOWN_SESSION;
    player->session = session;
    memcpy(player->memory, from + LABIAL_BESIDE_HEAD, player->outputs);
    for (k = 0; k < from[3]; k++) {
        uint8_t *const place = beside_place(player, frame + k);
        if (frame + k - player->now < player->frames && *place != MARK_SHOWN) {
            memcpy(place + 1, from + LABIAL_BESIDE_HEAD + (k + 1u) * player->outputs, player->outputs);
            *place = MARK_WAITS;
        }
    }
    return result;
}

int labial_beside_tick(labial_beside_t *player, uint32_t sample, uint8_t *values)
{
    uint32_t frame, passed;
    unsigned left = 1;
    uint8_t *place, *rest, *pose, *goal, *limits, i;
    if (!player || !values)
        return LABIAL_ERROR_NULL;
    if (!player->known)
        return LABIAL_ERROR_STATE;
    frame = beside_frame(player, sample);
    passed = frame - player->now;
    if (passed < NUMBERS_HALF)
        move_window(player, frame, passed);
    else if (0u - passed >= player->frames)
        move_window(player, frame, player->frames);
    rest = player->memory;
    pose = rest + player->outputs;
    goal = pose + player->outputs;
    limits = goal + player->outputs;
    place = beside_place(player, frame);
    if (frame == player->now && *place == MARK_WAITS) {
        *place = MARK_SHOWN;
        memcpy(goal, place + 1, player->outputs);
        player->quiet = 0;
        player->left = LABIAL_BESIDE_EASE;
    } else if (player->quiet < QUIET_MOST) {
        player->quiet++;
    }
    if (player->quiet == QUIET_MOST) {
        goal = rest;
        left = player->left;
        if (left > 1u)
            player->left--;
    }
    for (i = 0; i < player->outputs; i++)
        pose[i] = nearer(pose[i], goal[i], left, limits[i]);
    memcpy(values, pose, player->outputs);
    return player->quiet < QUIET_MOST ? LABIAL_OK : LABIAL_STARVED;
}

int labial_beside_cancel(labial_beside_t *player, uint32_t milliseconds)
{
    if (!player)
        return LABIAL_ERROR_NULL;
    if (player->outputs == 0)
        return LABIAL_ERROR_STATE;
    if (milliseconds > LABIAL_CANCEL_MAX * BESIDE_FRAME_MS)
        milliseconds = LABIAL_CANCEL_MAX * BESIDE_FRAME_MS;
    drop_frames(player);
    player->left = (uint16_t)(milliseconds > 0u ? (milliseconds + BESIDE_FRAME_MS - 1u) / BESIDE_FRAME_MS : 1u);
    return LABIAL_OK;
}

int32_t labial_beside_value(uint8_t byte, int32_t at_0, int32_t at_255)
{
    const uint32_t span = at_255 < at_0 ? (uint32_t)(at_0 - at_255) : (uint32_t)(at_255 - at_0);
    const int32_t move = (int32_t)((span * byte + 127u) / 255u);
    return at_255 < at_0 ? at_0 - move : at_0 + move;
}
