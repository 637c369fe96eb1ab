/* What the patched lines of openai_demo stand in. A comment `hunk N of FILE` is replaced by that hunk as patched. */
#include <stddef.h>
/* hunk 1 of media_sys.c */

typedef struct {
    void *play_handle;
} i2s_render_cfg_t;
audio_render_handle_t av_render_alloc_i2s_render(i2s_render_cfg_t *cfg);
void *get_playback_handle(void);
int build_player_system(void);
static struct {
    audio_render_handle_t audio_render;
} player_sys;

int build_player_system(void)
{
    i2s_render_cfg_t i2s_cfg = {
        .play_handle = get_playback_handle(),
        /* hunk 2 of media_sys.c */
        return -1;
}
return 0;
}
