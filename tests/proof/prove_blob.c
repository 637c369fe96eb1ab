/*
 * Any bytes, of any size up to more than the largest counts ask for, and of some sizes in an array that ends with them.
 * labial_model_check() is proven on its own, for tables as long as its counts ask for, as those of a blob are; its
 * stand-in here reads whatever a model is made of.
 */
#include "labial/blob.h"

#include <string.h>

#include "prove.h"

#define ROOM 0x1000000 /* more than a model of the largest counts takes */

static uint8_t bytes[ROOM];

static int is_there(const void *table)
{
    return table != 0;
}

int labial_model_check(const labial_model_t *model)
{
    int sum = model->format + model->frames_per_second + model->component_count + model->phoneme_count +
              model->class_count + model->state_count + model->predecessor_fours + model->search_stride +
              model->silence + model->mixture_mean + model->kernel_taps + model->kernel_stride + model->kernel_behind +
              model->floor_count + model->pair_knots + model->pair_count + model->channel_count;
    sum += is_there(model->phonemes) + is_there(model->components) + is_there(model->contexts) +
           is_there(model->shapes) + is_there(model->slopes) + is_there(model->kernels) + is_there(model->pair_keys) +
           is_there(model->pairs) + is_there(model->floors) + is_there(model->contacts) + is_there(model->protrusion);
    for (unsigned k = 0; k < LABIAL_CHANNELS; k++)
        sum += model->sources[k];
    for (unsigned k = 0; k < LABIAL_CHANNELS; k++) {
        const labial_channel_t *channel = &model->channels[k];
        sum += channel->centre + channel->shape_scale + channel->slope_scale + channel->kernel_scale +
               channel->pair_scale + channel->motion_scale[0] + channel->motion_scale[1] + channel->contact_weight;
        sum += is_there(channel->emissions) + is_there(channel->states) + is_there(channel->transitions) +
               is_there(channel->initials);
    }
    return any_int ? sum : any_int;
}

static void load(const uint8_t *data, size_t size)
{
    labial_blob_t blob;
    memset(blob.channels, 0, sizeof blob.channels); /* EVA cannot tell that what is not damaged was written */
    labial_model_load(&blob, data, size);
}

int main(void)
{
    static const size_t sizes[] = { 0, 11, 12, 31, 32, 33, 35, 36, 600, 4096, 65536, ROOM };
    labial_blob_t blob;
    FILL(bytes);
    labial_model_load(0, bytes, sizeof bytes);
    labial_model_load(&blob, 0, sizeof bytes);
    load(bytes, Frama_C_size_t_interval(0, ROOM));
    for (unsigned i = 0; i < sizeof sizes / sizeof sizes[0]; i++)
        load(bytes + ROOM - sizes[i], sizes[i]);
    return 0;
}
