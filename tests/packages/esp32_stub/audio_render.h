/* Stub of the renderers of Espressif's av_render. */
#ifndef AUDIO_RENDER_H
#define AUDIO_RENDER_H

#include <stdbool.h>
#include <stdint.h>

typedef struct {
    uint8_t channel, bits_per_sample;
    uint32_t sample_rate;
} av_render_audio_frame_info_t;
typedef struct {
    uint32_t pts;
    uint8_t *data;
    int size;
    bool eos;
} av_render_audio_frame_t;

typedef void *audio_render_handle_t;
typedef struct {
    audio_render_handle_t (*init)(void *cfg, int cfg_size);
    int (*open)(audio_render_handle_t render, av_render_audio_frame_info_t *info);
    int (*write)(audio_render_handle_t render, av_render_audio_frame_t *audio_data);
    int (*get_latency)(audio_render_handle_t render, uint32_t *latency);
    int (*get_frame_info)(audio_render_handle_t render, av_render_audio_frame_info_t *info);
    int (*set_speed)(audio_render_handle_t render, float speed);
    int (*close)(audio_render_handle_t render);
    void (*deinit)(audio_render_handle_t render);
} audio_render_ops_t;
typedef struct {
    audio_render_ops_t ops;
    void *cfg;
    int cfg_size;
} audio_render_cfg_t;

audio_render_handle_t audio_render_alloc_handle(audio_render_cfg_t *cfg);
int audio_render_open(audio_render_handle_t render, av_render_audio_frame_info_t *info);
int audio_render_write(audio_render_handle_t render, av_render_audio_frame_t *audio_data);
int audio_render_get_latency(audio_render_handle_t render, uint32_t *latency);
int audio_render_set_speed(audio_render_handle_t render, float speed);
int audio_render_get_frame_info(audio_render_handle_t render, av_render_audio_frame_info_t *info);
int audio_render_close(audio_render_handle_t render);
void audio_render_free_handle(audio_render_handle_t render);

#endif
