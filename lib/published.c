/*
 * published.c - the channel step (channels.h) of a build to the letter, with LABIAL_PAPER: each unit is searched as a
 * whole, solved as a whole, and cross-faded with the next (docs/method.md, Units and search to Equation 3).
 *
 *     | piece: boundary phoneme .. boundary phoneme |
 *                                | shared | .. the next one's boundary phoneme |
 *
 * A piece is a unit, or a part of one that is longer than LABIAL_PIECE frames. It is searched and solved in the tick
 * that takes its last frame, all channels at once. Nothing is taken over from one piece to the next: the search begins
 * with the initial probabilities, and the frames that two pieces share are searched and solved twice.
 *
 * No frame of a piece is known before its last one is taken, LABIAL_PIECE - 1 frames after its first one at most; that
 * is the delay.
 */
#include "channels.h"

#include <string.h>

#include "fixed.h"
#include "trajectory.h"
#include "units.h"
#include "viterbi.h"

#if LABIAL_PAPER

/* Most frames that two pieces share. */
#define OVERLAP 8u

/* The cost of a state that no path reaches; above every other one. */
#define UNREACHED ((uint32_t)1 << 30)

labial_shape_t *labial_channels_init(labial_channels_t *channels, unsigned stride, unsigned width, void *workspace)
{
    (void)width;
    channels->width = LABIAL_CHANNELS;
    channels->stride = (uint8_t)stride;
    channels->pieces = (labial_pieces_t *)workspace;
    return (labial_shape_t *)(void *)(channels->pieces + 1);
}

void labial_channels_reset(labial_channels_t *channels)
{
    memset(channels->pieces, 0, sizeof *channels->pieces);
    channels->phase = channels->entered = channels->beyond = channels->place = 0;
    channels->frames = channels->shared = channels->phoneme = 0;
}

/* The place in the rings of the frame of an age: how many ticks ago it was accepted. */
static unsigned place_of(const labial_channels_t *channels, unsigned age)
{
    return channels->place >= age ? channels->place - age : channels->place + LABIAL_PIECE - age;
}

static void move_on(labial_channels_t *channels)
{
    channels->place = (uint8_t)(channels->place + 1u < LABIAL_PIECE ? channels->place + 1u : 0u);
    if (channels->entered < 255u)
        channels->entered++;
}

labial_frame_t *labial_channels_enter(labial_channels_t *channels, const labial_model_t *const models[LABIAL_MODELS],
                                      unsigned slot)
{
    (void)models;
    move_on(channels);
    channels->slots[channels->place] = (uint8_t)slot;
    return &channels->pieces->frames[channels->place];
}

void labial_channels_run_out(labial_channels_t *channels)
{
    move_on(channels);
    channels->beyond++;
}

int labial_channels_due(const labial_channels_t *channels, const labial_model_t *const models[LABIAL_MODELS],
                        int16_t frame[LABIAL_CHANNELS])
{
    const unsigned place = place_of(channels, LABIAL_DELAY(0u));
    if (channels->entered <= LABIAL_DELAY(0u))
        return 0;
    labial_followers_complete(models[channels->slots[place]], channels->pieces->motion[0] + place, LABIAL_PIECE, frame);
    return 1;
}

/* ---- Pieces ------------------------------------------------------------------------------------------------------ */

/* Adds the accepted frame to the piece; returns whether it is the last one. `*fade` is how many frames the piece
 * shares with the next one then. */
static int ends_piece(labial_channels_t *channels, unsigned *fade)
{
    const unsigned marks = channels->pieces->frames[channels->place].marks, frames = ++channels->frames;
    unsigned least = OVERLAP;
    if (marks & LABIAL_PHONEME_BEGINS) /* no unit ends with the phoneme that it begins with */
        channels->phoneme = (uint8_t)(marks & LABIAL_BEGINS ? 0 : 1);
    else if (channels->phoneme > 0)
        channels->phoneme++;
    *fade = 0;
    if (marks & LABIAL_ENDS)
        return 1;
    if ((marks & LABIAL_UNIT_ENDS) && channels->phoneme > 0) {
        least = channels->phoneme < frames / 2u ? channels->phoneme : frames / 2u;
        *fade = least < OVERLAP ? least : OVERLAP;
        return 1;
    }
    *fade = OVERLAP;
    return frames == LABIAL_PIECE;
}

/* One channel of a piece. */
typedef struct {
    const labial_channels_t *channels;
    const labial_model_t *model;
    unsigned channel;
    unsigned frames, shared; /* of the piece, and with the one before */
} part_t;

/* The place in the rings of frame `t` of the piece. */
static unsigned place_at(const part_t *part, unsigned t)
{
    return place_of(part->channels, part->frames - 1u - t);
}

/* The least cost of reaching a state by its transitions; UNREACHED where it has none from a state that is reached. */
static uint32_t reach(const uint32_t *costs, const labial_transition_t *transition, unsigned count,
                      uint8_t *predecessor)
{
    uint32_t least = UNREACHED;
    *predecessor = 0;
    for (; count > 0; count--, transition++) {
        const uint32_t cost = costs[transition->predecessor] + transition->cost;
        if (cost < least) {
            least = cost;
            *predecessor = transition->predecessor;
        }
    }
    return least;
}

/* The Viterbi search: the most probable states of the piece's steps, the lower one at a tie. A step has as many frames
 * as share a state, and sees the target of the middle one or of the last. */
static void search(const part_t *part, uint8_t path[LABIAL_PIECE])
{
    const labial_model_t *model = part->model;
    const labial_channel_t *channel = &model->channels[part->channel];
    const unsigned states = model->state_count, stride = part->channels->stride;
    const unsigned into = 4u * model->predecessor_fours; /* each of them */
    labial_pieces_t *pieces = part->channels->pieces;
    uint32_t costs[2][LABIAL_STATES_MAX], *now = costs[0], *before = costs[1];
    unsigned steps = 0, begin, i, best;
    for (begin = 0; begin < part->frames; begin += stride, steps++) {
        const unsigned seen = begin + stride / 2u < part->frames ? begin + stride / 2u : part->frames - 1u;
        const int32_t position = pieces->frames[place_at(part, seen)].target[part->channel];
        uint32_t *const earlier = now;
        now = before;
        before = earlier;
        for (i = 0; i < states; i++) {
            const uint32_t cost =
                steps == 0 ? channel->initials[i]
                           : reach(before, channel->transitions + (size_t)i * into, into, &pieces->back[steps][i]);
            now[i] = cost < UNREACHED ? cost + labial_viterbi_emission(&channel->emissions[i], position) : UNREACHED;
        }
    }
    for (i = 1, best = 0; i < states; i++)
        if (now[i] < now[best])
            best = i;
    for (i = steps; i-- > 0;) {
        path[i] = (uint8_t)best;
        best = pieces->back[i][best];
    }
}

/* Solves equation 3 for a path and puts the motion into its ring, cross-faded with what is there of the piece
 * before. */
static void solve(const part_t *part, const uint8_t path[LABIAL_PIECE])
{
    const labial_channel_t *channel = &part->model->channels[part->channel];
    const unsigned stride = part->channels->stride;
    labial_pieces_t *pieces = part->channels->pieces;
    int16_t *motion = pieces->motion[part->channel], earlier[OVERLAP];
    labial_factors_t factors[LABIAL_PIECE];
    labial_solver_t solver;
    unsigned t, left = stride;
    memset(&solver, 0, sizeof solver);
    for (t = 0; t < part->shared; t++)
        earlier[t] = motion[place_at(part, t)];
    for (t = 0; t < part->frames; t++) {
        const unsigned place = place_at(part, t);
        labial_terms_t terms;
        labial_trajectory_terms(channel, *path, pieces->gains[place], &terms);
        pieces->frames[place].marks =
            (uint8_t)((t == 0 ? LABIAL_BEGINS : 0) | (t + 1u == part->frames ? LABIAL_ENDS : 0));
        labial_trajectory_rows(&solver, &terms, &pieces->frames[place], part->channel, 1, factors + t);
        if (--left == 0) {
            left = stride;
            path++;
        }
    }
    labial_trajectory_back(factors + part->frames - 1, 0, part->frames, part->channels->place, LABIAL_PIECE, motion);
    for (t = 0; t < part->shared; t++) {
        const int32_t share = (int32_t)labial_quotient((t + 1u) << 14, part->shared + 1u);
        int16_t *const to = &motion[place_at(part, t)];
        *to = (int16_t)(earlier[t] + (((*to - earlier[t]) * share + 8192) >> 14));
    }
}

void labial_channels_step(labial_channels_t *channels, const labial_model_t *const models[LABIAL_MODELS], int32_t gain)
{
    uint8_t path[LABIAL_PIECE];
    unsigned count, fade;
    part_t part;
    if (channels->beyond > 0)
        return;
    channels->pieces->gains[channels->place] = (int16_t)gain;
    if (!ends_piece(channels, &fade))
        return;
    part.channels = channels;
    part.model = models[channels->slots[channels->place]];
    part.frames = channels->frames;
    part.shared = channels->shared;
    count = part.model->channel_count;
    for (part.channel = 0; part.channel < count; part.channel++) {
        search(&part, path);
        solve(&part, path);
    }
    channels->frames = channels->shared = (uint8_t)fade;
    channels->phoneme = 0;
}

#endif
