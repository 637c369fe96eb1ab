/*
 * ears.c - hearing without structures (flat.h).
 */
#include "flat.h"

#include <string.h>

#include "hearing.h"

typedef struct {
    const char *name;
    const labial_hear_model_t *model;
    const char *const *classes;
} hearing_t;

static const hearing_t bundled[] = { LABIAL_BUNDLED_HEARING{ 0, 0, 0 } };

#define BUNDLED (sizeof bundled / sizeof bundled[0] - 1u)

FLAT_RETURNS(uint32_t ears_size(void), sizeof(ears_t))
FLAT_RETURNS(const char *hearing_name(unsigned number), number < BUNDLED ? bundled[number].name : NULL)
FLAT_RETURNS(const labial_hear_model_t *hearing_model(unsigned number), number < BUNDLED ? bundled[number].model : NULL)
FLAT_RETURNS(unsigned hearing_classes(unsigned number), number < BUNDLED ? bundled[number].model->classes : 0)
FLAT_RETURNS(const char *hearing_class(unsigned number, unsigned shown),
             shown < hearing_classes(number) ? bundled[number].classes[shown] : NULL)

static void take_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    ears_t *ears = (ears_t *)user;
    (void)frame;
    if (ears->faps && ears->frame_count < ears->room)
        memcpy(ears->faps + ears->frame_count * LABIAL_CHANNELS, faps, LABIAL_CHANNELS * sizeof *faps);
    if (ears->visemes && ears->frame_count < ears->room)
        (void)labial_hear_visemes(&ears->hear, labial_heard_visemes,
                                  ears->visemes + ears->frame_count * LABIAL_VISEMES);
    ears->frame_count++;
}

static void take_stretch(void *user, unsigned shown, uint32_t frame, uint32_t frames)
{
    ears_t *ears = (ears_t *)user;
    if (ears->stretches && ears->stretch_count < ears->room) {
        uint32_t *to = ears->stretches + 3u * ears->stretch_count;
        to[0] = shown;
        to[1] = frame;
        to[2] = frames;
    }
    ears->stretch_count++;
}

static void take_to(ears_t *ears, int16_t *faps, uint8_t *visemes, uint32_t *stretches, uint32_t room)
{
    ears->faps = faps;
    ears->visemes = visemes;
    ears->stretches = stretches;
    ears->room = room;
    ears->frame_count = ears->stretch_count = 0;
}

static int taken(const ears_t *ears, int result)
{
    return result == LABIAL_OK ? (int)ears->frame_count : result;
}

int ears_init(ears_t *ears, const labial_hear_model_t *model, uint32_t samples_per_second, unsigned channels)
{
    const int result = labial_hear_init(&ears->hear, model, samples_per_second, channels, ears->workspace,
                                        sizeof ears->workspace, take_frame, ears);
    take_to(ears, NULL, NULL, NULL, 0);
    return result == LABIAL_OK ? labial_hear_classes(&ears->hear, take_stretch) : result;
}

FLAT_RETURNS(uint32_t ears_latency(const ears_t *ears), labial_hear_latency(&ears->hear).delay_milliseconds)

int ears_push(ears_t *ears, const int16_t *samples, uint32_t count, int16_t *faps, uint8_t *visemes,
              uint32_t *stretches, uint32_t room)
{
    take_to(ears, faps, visemes, stretches, room);
    return taken(ears, labial_hear_push(&ears->hear, samples, count));
}

int ears_end(ears_t *ears, int16_t *faps, uint8_t *visemes, uint32_t *stretches, uint32_t room)
{
    take_to(ears, faps, visemes, stretches, room);
    return taken(ears, labial_hear_end(&ears->hear));
}

int ears_cancel(ears_t *ears, uint32_t milliseconds, int16_t *faps, uint8_t *visemes, uint32_t *stretches,
                uint32_t room)
{
    take_to(ears, faps, visemes, stretches, room);
    return taken(ears, labial_hear_cancel(&ears->hear, milliseconds));
}

FLAT_RETURNS(uint32_t ears_stretches(const ears_t *ears), ears->stretch_count)
FLAT_RETURNS(int ears_restart(ears_t *ears), labial_hear_restart(&ears->hear))
FLAT_RETURNS(int ears_exact(ears_t *ears, unsigned exact), labial_hear_exact(&ears->hear, exact != 0))
FLAT_RETURNS(unsigned ears_level(const ears_t *ears), labial_hear_level(&ears->hear))
FLAT_RETURNS(int ears_set_level(ears_t *ears, unsigned level), labial_hear_set_level(&ears->hear, level))
FLAT_RETURNS(int ears_articulation(ears_t *ears, unsigned percent), labial_hear_articulation(&ears->hear, percent))
