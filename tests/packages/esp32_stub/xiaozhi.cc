// What the patched lines of xiaozhi-esp32 stand in. A comment `hunk N of FILE` is replaced by that hunk as patched.
#include <esp_timer.h>
#include <memory>
#include <vector>
/* hunk 1 of audio_service.cc */

struct AudioTask {
    std::vector<int16_t> pcm;
/* hunk 1 of audio_service.h */

class AudioCodec {
public:
    void Start();
    int output_sample_rate() const;
    void OutputData(std::vector<int16_t> &data);
};

class AudioService {
    AudioCodec *codec_;
    void Initialize(AudioCodec *codec);
    void AudioOutputTask(std::unique_ptr<AudioTask> task);
    std::unique_ptr<AudioTask> OpusCodecTask(bool resampled);
};

void AudioService::Initialize(AudioCodec *codec)
{
    codec_ = codec;
    /* hunk 2 of audio_service.cc */
}

void AudioService::AudioOutputTask(std::unique_ptr<AudioTask> task)
{
    /* hunk 3 of audio_service.cc */
}

std::unique_ptr<AudioTask> AudioService::OpusCodecTask(bool resampled)
{
    bool decoded = false;
    auto task = std::make_unique<AudioTask>();
    {
        if (resampled) {
            /* hunk 4 of audio_service.cc */
    }
    return decoded ? std::move(task) : nullptr;
}
