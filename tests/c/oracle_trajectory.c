/*
 * oracle_trajectory.c - equation 3 as a system of equations, and streams put together of all steps.
 */
#include "oracle.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Equation 3 ---- */

/* An equation: what frames t - 2 .. t + 2 weigh in it, and its right-hand side. */
typedef struct {
    double a[5], right;
} equation_t;

/* Adds a row of W around frame t, with its precision and mean. */
static void add_row(equation_t *equations, size_t t, double before, double own, double behind, double precision,
                    double mean)
{
    const double w[3] = { before, own, behind };
    for (int i = -1; i <= 1; i++) {
        if (w[i + 1] == 0.0)
            continue;
        for (int k = -1; k <= 1; k++)
            equations[(ptrdiff_t)t + i].a[2 + k - i] += w[i + 1] * w[k + 1] * precision;
        equations[(ptrdiff_t)t + i].right += w[i + 1] * precision * mean;
    }
}

/* A position with an articulation: the same from FAP 0, which is as far as its channel's centre from 0. */
static double articulated(const labial_channel_t *channel, double position, double gain)
{
    return (channel->centre + position) * gain - channel->centre;
}

static void fill(equation_t *equations, const labial_channel_t *channel, const uint8_t *path, const int16_t *targets,
                 const uint16_t *contacts, unsigned bit, const int32_t *gains, size_t count)
{
    for (size_t t = 0; t < count; t++) {
        const int32_t gain = gains ? gains[t] : 256;
        const double g = gain / 256.0;
        const labial_state_t *state = &channel->states[path[t]];
        const double firm = fixture_weight_value(channel->contact_weight);
        double hold = fixture_weight_value(state->hold);
        /* of the target in where the frame is held, which has 12 bits */
        const double share = (state->share < 128 ? state->share : state->share + 1) * gain / 16 / 4096.0;
        if (contacts[t] >> bit & 1u) {
            hold = firm > hold ? firm : hold;
            add_row(equations, t, 0, 1, 0, hold, articulated(channel, targets[t], g < 1.0 ? g : 1.0));
        } else {
            add_row(equations, t, 0, 1, 0, hold,
                    articulated(channel, state->mean, g) + share * (targets[t] - state->mean));
        }
        if (t == 0 || t + 1 == count)
            continue;
        add_row(equations, t, -0.5, 0, 0.5, 4.0 * fixture_weight_value(state->weight[0]),
                fixture_motion(channel, state, 0, gain));
        add_row(equations, t, 1, -2, 1, fixture_weight_value(state->weight[1]),
                fixture_motion(channel, state, 1, gain));
    }
}

void oracle_trajectory(const labial_channel_t *channel, const uint8_t *path, const int16_t *targets,
                       const uint16_t *contacts, unsigned bit, const int32_t *gain, size_t count, const size_t *start,
                       double *motion)
{
    equation_t *e = (equation_t *)fixture_room(count + 2, sizeof *e);
    fill(e, channel, path, targets, contacts, bit, gain, count);
    for (size_t t = 0; t < count; t++) /* Gauss: frame t leaves the two equations behind its own */
        for (size_t i = 1; i <= 2 && t + i < count; i++) {
            const double factor = e[t + i].a[2 - i] / e[t].a[2];
            e[t + i].a[3 - i] -= factor * e[t].a[3];
            e[t + i].a[4 - i] -= factor * e[t].a[4];
            e[t + i].right -= factor * e[t].right;
        }
    for (size_t t = 0; t < count; t++) {
        const size_t from = start ? start[t] : count - 1;
        const double *a = e[from].a;
        double m1 = e[from].right / (a[2] + a[3] + a[4]), m2 = m1; /* as if the next two were equal to it */
        for (size_t i = from; i-- > t;) {
            const double m = (e[i].right - e[i].a[3] * m1 - e[i].a[4] * m2) / e[i].a[2];
            m2 = m1;
            m1 = m;
        }
        motion[t] = m1 + channel->centre;
    }
    free(e);
}

/* Where the way back to a stream's frames `first` .. `first` + `count` - 1 begins, counted from `first`. */
static void starts(const labial_model_t *model, unsigned channel, size_t first, size_t count, size_t *start)
{
    const size_t stride = model->search_stride, last = first + count - 1;
    for (size_t t = 0; t < count; t++) {
        /* the channel's first turn in which the frame is due; the frame LABIAL_LAG before it has its row, and what came
         * before that all it is tied to */
        size_t turn = first + t + LABIAL_WINDOW + LABIAL_LAG + 1;
        while (turn % stride != channel % stride)
            turn++;
        start[t] = (last <= turn - LABIAL_LAG ? last : turn - LABIAL_LAG - 1) - first;
    }
}

/* ---- The channels that follow others ---- */

/* The frame that the motion of a model's channels makes, in place, Q4 FAP. */
static void complete(const labial_model_t *model, double motion[LABIAL_CHANNELS])
{
    const labial_protrusion_t *table = model->protrusion;
    double own[LABIAL_CHANNELS];
    memcpy(own, motion, sizeof own);
    for (unsigned k = 0; k < LABIAL_CHANNELS; k++)
        motion[k] = own[model->sources[k] < LABIAL_CHANNELS ? model->sources[k] : 0];
    if (model->sources[2] != 255)
        return;
    double at = ((motion[5] + motion[6]) / 2 - table->low) * 2 * table->gain / 1048576; /* intervals of 2^20 / gain */
    at = at < 0 ? 0 : at > 16 ? 16 : at;
    const int i = at < 15 ? (int)at : 15;
    motion[2] = table->values[i] + (at - i) * (table->values[i + 1] - table->values[i]);
}

/* ---- A whole stream ---- */

#define FADE 8
#define MOST 6000 /* frames of a solution */

typedef struct {
    const labial_model_t *const *models;
    oracle_frame_t *frames;
    int16_t (*targets)[LABIAL_CHANNELS];
    uint16_t *contacts;
    int32_t *reached; /* articulation of each frame, in 1/256 */
    size_t count;
} stream_t;

/* What the articulation is when a frame is taken in: it is 10 percent nearer to what is told than before. */
static void reach(const stream_t *stream, const uint8_t *told)
{
    int percent = told && stream->count > 0 ? told[0] : 100;
    for (size_t t = 0; t < stream->count; t++) {
        const int way = (told ? told[t] : 100) - percent;
        percent += way > 10 ? 10 : way < -10 ? -10 : way;
        stream->reached[t] = (percent * 256 + 50) / 100;
    }
}

/* The articulation of a channel's frame: that of the frame that is taken in when its row is made, in the channel's next
 * turn after LABIAL_LAG frames. */
static int32_t gain_at(const stream_t *stream, unsigned channel, size_t t)
{
    const size_t stride = stream->models[0]->search_stride;
    size_t turn = t + LABIAL_LAG;
    while (turn % stride != channel % stride)
        turn++;
    return stream->reached[turn < stream->count ? turn : stream->count - 1];
}

static double limited(double value)
{
    return value > INT16_MAX ? INT16_MAX : value < -INT16_MAX ? -INT16_MAX : value;
}

/* The motion of one solution. */
static void solve(const stream_t *stream, size_t first, size_t count, double (*motion)[LABIAL_CHANNELS])
{
    const labial_model_t *model = stream->models[stream->frames[first].model];
    const int16_t(*all)[LABIAL_CHANNELS] = (const int16_t(*)[LABIAL_CHANNELS])(stream->targets + first);
    struct {
        uint8_t path[MOST];
        int16_t targets[MOST];
        size_t start[MOST];
        double motion[MOST];
        int32_t gain[MOST];
    } *own = fixture_room(1, sizeof *own);
    if (count > MOST)
        abort();
    for (unsigned c = 0; c < model->channel_count; c++) {
        oracle_search(model, c, stream->frames + first, all, first, count, own->path);
        for (size_t t = 0; t < count; t++) {
            own->targets[t] = all[t][c];
            own->gain[t] = gain_at(stream, c, first + t);
        }
        starts(model, c, first, count, own->start);
        oracle_trajectory(&model->channels[c], own->path, own->targets, stream->contacts + first, c, own->gain, count,
                          own->start, own->motion);
        for (size_t t = 0; t < count; t++)
            motion[first + t][c] = limited(own->motion[t]);
    }
    for (size_t t = 0; t < count; t++)
        complete(model, motion[first + t]);
    free(own);
}

/* Step j of a fade of `length`, from `held`, which moves on by `pace` / 2, / 4, ... */
static double faded(double fresh, double held, double pace, unsigned j, unsigned length)
{
    const double s = j < length ? (double)j / length : 1.0, share = s * s * (3.0 - 2.0 * s);
    const double base = held + pace * (1.0 - 1.0 / (double)(1u << j));
    return base + (fresh - base) * share;
}

/* Steps in which jaw and lips fade from `held` to the solution that begins with frame `t`: until the second frame in
 * contact, as far as contacts are known when the frame is delivered, if they are apart and this is sooner. */
static unsigned closing_steps(const stream_t *stream, size_t t, const double *held)
{
    const size_t known = LABIAL_DELAY(stream->models[0]->search_stride);
    const double apart = -floor(floor(held[3] + 0.5) / 16.0 + 0.5) - floor(floor(held[4] + 0.5) / 16.0 + 0.5);
    for (size_t k = 0; apart > 24.0 && k < FADE && k <= known && t + k < stream->count; k++) {
        if (k > 0 && stream->frames[t + k].begins)
            break;
        if (stream->contacts[t + k])
            return (unsigned)k + 2u;
    }
    return FADE + 1u;
}

static void fade(const stream_t *stream, const double *pose, double (*motion)[LABIAL_CHANNELS])
{
    double held[LABIAL_CHANNELS] = { 0 }, pace[LABIAL_CHANNELS] = { 0 };
    unsigned j = 0, closing = 0;
    int is_paced = 0; /* neither of the two frames before is missing, and the later one did not fade */
    for (size_t t = 0; t < stream->count; t++) {
        if (stream->frames[t].begins) {
            for (unsigned c = 0; c < LABIAL_CHANNELS; c++) {
                held[c] = t > 0 ? motion[t - 1][c] : pose ? pose[c] : 0.0;
                pace[c] = is_paced ? held[c] - motion[t - 2][c] : 0.0;
            }
            closing = closing_steps(stream, t, held);
            j = 1;
        }
        for (unsigned c = 0; j > 0 && c < LABIAL_CHANNELS; c++) {
            const int closes = c == 0 || c == 3 || c == 4 || (c >= 7 && c <= 10); /* FAPs 3, 51, 52, 55 to 58 */
            motion[t][c] = limited(faded(motion[t][c], held[c], pace[c], j, closes ? closing : FADE + 1u));
        }
        is_paced = t > 0 && j == 0;
        j = j > 0 && j < FADE ? j + 1 : 0;
    }
}

size_t oracle_stream(const labial_model_t *const *models, const fixture_phoneme_t *input, size_t count,
                     const double *held, const uint8_t *told, double (*motion)[LABIAL_CHANNELS], size_t room)
{
    stream_t stream = { models,
                        (oracle_frame_t *)fixture_room(room, sizeof *stream.frames),
                        (int16_t(*)[LABIAL_CHANNELS])fixture_room(room, sizeof *stream.targets),
                        (uint16_t *)fixture_room(room, sizeof *stream.contacts),
                        (int32_t *)fixture_room(room, sizeof *stream.reached),
                        0 };
    stream.count = oracle_units(models, input, count, stream.frames, room);
    oracle_targets(models, stream.frames, stream.count, stream.targets, stream.contacts);
    reach(&stream, told);
    for (size_t first = 0, t = 0; t < stream.count; t++)
        if (stream.frames[t].ends) {
            solve(&stream, first, t + 1 - first, motion);
            first = t + 1;
        }
    fade(&stream, held, motion);
    free(stream.frames);
    free(stream.targets);
    free(stream.contacts);
    free(stream.reached);
    return stream.count;
}
