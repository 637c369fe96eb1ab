/*
 * Any model, phonemes, duration and neighbours; any shape, and any frame that units.c may take, with labels as far as
 * the kernels of a checked model reach and no farther. Phonemes with one to eight components are taken one by one, as
 * are one and two knots of pairs, and kernels of every stride and number of taps.
 */
#include "any_model.h"
#include "shape.h"

static labial_model_t model;

static void select_among(int count, int knots)
{
    labial_spoken_t spoken;
    labial_selection_t selection = { 0 }; /* as labial_init() makes it */
    labial_shape_t shape[LABIAL_CHANNELS];
    FILL(shape); /* the workspace */
    selection.shape = shape;
    spoken.slot = any_uint8;
    spoken.phoneme = (uint8_t)Frama_C_interval(0, LABIAL_PHONEMES_MAX - 1);
    spoken.previous = (uint8_t)Frama_C_interval(0, LABIAL_PHONEMES_MAX - 1);
    spoken.next = (uint8_t)Frama_C_interval(0, LABIAL_PHONEMES_MAX - 1);
    spoken.ms = any_uint16;
    any_phonemes(count);
    model.pair_knots = (uint8_t)knots;
    labial_shape_select(&model, &spoken, &selection);
    labial_shape_select(&model, &spoken, &selection);
}

/* Any frame. */
static void take(void)
{
    labial_taken_t taken;
    labial_shape_t shape[LABIAL_CHANNELS];
    uint8_t labels[2 * LABIAL_REACH + 1];
    int16_t target[LABIAL_CHANNELS];
    int i;
    FILL(target); /* the workspace, which a reset sets to zero: EVA cannot tell that a model's channels were written */
    for (i = 0; i < LABIAL_CHANNELS; i++)
        shape[i].knots[0] = any_position();
    for (i = 0; i < LABIAL_CHANNELS; i++)
        shape[i].knots[1] = any_position();
    for (i = 0; i < 2 * LABIAL_REACH + 1; i++)
        labels[i] = (uint8_t)Frama_C_interval(0, LABIAL_PHONEMES_MAX - 1);
    taken.labels = labels + LABIAL_REACH;
    taken.share = (uint16_t)Frama_C_interval(0, 16384);
    taken.slot = any_uint8;
    taken.is_first = (uint8_t)Frama_C_interval(0, 1);
    taken.is_open = (uint8_t)Frama_C_interval(0, 1);
    taken.rest = (uint8_t)Frama_C_interval(0, LABIAL_REST_FRAMES);
    taken.marks = any_uint8;
    labial_shape_target(&model, shape, &taken, target);
}

/* Kernels of every length and place with this stride: `room` taps at most to either side of the frame. */
static void aim(int stride, int room)
{
    int taps;
    model.kernel_stride = (uint8_t)stride;
    /*@ loop unroll 32; */
    for (taps = 1; taps <= LABIAL_KERNEL_TAPS_MAX && taps <= 2 * room + 1; taps++) {
        model.kernel_taps = (uint8_t)taps;
        model.kernel_behind =
            (uint8_t)Frama_C_interval(taps - 1 > room ? taps - 1 - room : 0, taps > room ? room : taps - 1);
        take();
    }
}

int main(void)
{
    int count, knots, stride;
    any_model(&model, 1);
    /*@ loop unroll 8; */
    for (count = 1; count <= LABIAL_PHONEME_COMPONENTS_MAX; count++)
        for (knots = 1; knots <= 2; knots++)
            select_among(count, knots);
    model.kernel_taps = model.kernel_behind = 0;
    take();
    model.kernel_taps = 1;
    take();
    aim(0, LABIAL_KERNEL_TAPS_MAX - 1);
    /*@ loop unroll 20; */
    for (stride = 1; stride <= LABIAL_REACH; stride++)
        aim(stride, LABIAL_REACH / stride);
    return 0;
}
