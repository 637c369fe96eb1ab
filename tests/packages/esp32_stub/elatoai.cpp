// What the patched lines of ElatoAI stand in. A comment `hunk N of FILE` is replaced by that hunk as patched.
#include <esp_timer.h>
#include <stddef.h>
#define portMAX_DELAY 0xffffffffu
/* hunk 1 of Audio.cpp */

extern const int BITS_PER_SAMPLE;
/* hunk 1 of Audio.h */

extern const int CHANNELS;
extern const uint32_t SAMPLE_RATE;
extern const int I2S_SD_OUT, LOW, SPEAKING;
extern int deviceState;
extern float currentPitchFactor;
extern void *wsMutex;
void xSemaphoreTake(void *mutex, uint32_t wait);
void digitalWrite(int pin, int level);
struct WebSocketsClient {
    bool isConnected();
} extern webSocket;
struct Buffer {
    size_t writeArray(const uint8_t *data, size_t size);
} extern buffer_of_sound;
struct BufferPrint {
    Buffer &_buffer;
    size_t write(const uint8_t *buffer, size_t size);
} extern bufferPrint;
struct OpusAudioDecoder {
    void setOutput(BufferPrint &out);
} extern opusDecoder;
struct StreamCopy {
    size_t copy();
} extern copier, pitchCopier;
struct QueueStream {
    int read();
} extern queue;
extern volatile bool i2sOutputFlushScheduled;

size_t BufferPrint::write(const uint8_t *buffer, size_t size)
{
    /* hunk 2 of Audio.cpp */
    }
    return AUDIO_BUFFER_SIZE < AUDIO_CHUNK_SIZE ? 0 : size;
}

void transitionToListening()
{
    /* hunk 3 of Audio.cpp */
}

void audioStreamTask(void *)
{
    /* hunk 4 of Audio.cpp */
    /* hunk 5 of Audio.cpp */
        (void)i2sOutputFlushScheduled;
        /* hunk 6 of Audio.cpp */
        else {
        /* hunk 7 of Audio.cpp */
    }
}
