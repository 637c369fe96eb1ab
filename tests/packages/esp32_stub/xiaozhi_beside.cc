// What the patched lines of xiaozhi-esp32 for lips beside the sound stand in. A comment `hunk N of FILE` is replaced by
// that hunk as patched.
#include <esp_timer.h>
#include <functional>
#include <memory>
#include <vector>
/* hunk 1 of application.cc */
/* hunk 2 of application.cc */
/* hunk 1 of audio_service.cc */

struct AudioStreamPacket {
    int sample_rate = 0;
    int frame_duration = 0;
/* hunk 1 of protocol.h */
};

struct AudioTask {
    std::vector<int16_t> pcm;
/* hunk 1 of audio_service.h */

enum PowerSaveLevel { PERFORMANCE };
enum AbortReason { kAbortReasonNone };
enum DeviceState { kDeviceStateSpeaking };

struct AudioCodec {
    int output_sample_rate() const;
    void OutputData(std::vector<int16_t> &data);
};

struct Board {
    void SetPowerSaveLevel(PowerSaveLevel level);
};

struct Protocol {
    void OnIncomingAudio(std::function<void(std::unique_ptr<AudioStreamPacket> packet)> callback);
    void OnAudioChannelOpened(std::function<void()> callback);
    void SendAbortSpeaking(AbortReason reason);
};

class AudioService {
    AudioCodec *codec_;
    void AudioOutputTask(std::unique_ptr<AudioTask> task);
    std::unique_ptr<AudioTask> OpusCodecTask(std::unique_ptr<AudioStreamPacket> packet);
};

void AudioService::AudioOutputTask(std::unique_ptr<AudioTask> task)
{
    /* hunk 2 of audio_service.cc */
}

std::unique_ptr<AudioTask> AudioService::OpusCodecTask(std::unique_ptr<AudioStreamPacket> packet)
{
    auto task = std::make_unique<AudioTask>();
    /* hunk 3 of audio_service.cc */
    return task;
}

class Application {
    std::unique_ptr<Protocol> protocol_;
    DeviceState GetDeviceState() const;
    void InitializeProtocol(AudioCodec *codec, Board &board);
    void OnJson(const cJSON *root, const cJSON *type);
    void AbortSpeaking(AbortReason reason);
};

void Application::InitializeProtocol(AudioCodec *codec, Board &board)
{
    /* hunk 3 of application.cc */
        }
    });

    /* hunk 4 of application.cc */
    });
}

void Application::OnJson(const cJSON *root, const cJSON *type)
{
    if (type) {
        if (strcmp(type->valuestring, "llm") == 0) {
            if (root) {
            /* hunk 5 of application.cc */
        }
    }
}

void Application::AbortSpeaking(AbortReason reason)
{
    if (protocol_) {
        /* hunk 6 of application.cc */
}
