#include "apps/preview/video.h"

#include <array>
#include <csignal>
#include <cstdlib>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/base/atomic_file.h"
#include "core/base/error.h"

namespace toile::preview {

namespace {

/// Starts a program that reads from the returned stream; its process id goes to `process`.
std::FILE* spawn_reader(std::vector<std::string> words, int& process)
{
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0)
        return nullptr;
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);

    std::vector<char*> arguments;
    arguments.reserve(words.size() + 1);
    for (std::string& word : words)
        arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const int error = ::posix_spawnp(&process, arguments[0], &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    ::close(ends[0]);
    if (error != 0) {
        ::close(ends[1]);
        return nullptr;
    }
    return ::fdopen(ends[1], "wb");
}

/// Ignores SIGPIPE: a dead reader then causes a failed write instead of ending this program.
class IgnoreBrokenPipe {
public:
    IgnoreBrokenPipe() : previous_(std::signal(SIGPIPE, SIG_IGN)) {}
    ~IgnoreBrokenPipe() { std::signal(SIGPIPE, previous_); }
    IgnoreBrokenPipe(const IgnoreBrokenPipe&) = delete;
    IgnoreBrokenPipe& operator=(const IgnoreBrokenPipe&) = delete;

private:
    void (*previous_)(int);
};

} // namespace

bool is_on_path(const char* program)
{
    const char* const path = std::getenv("PATH");
    std::istringstream folders(path ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');)
        if (::access((folder + "/" + program).c_str(), X_OK) == 0)
            return true;
    return false;
}

void require_encoder(const std::filesystem::path& file)
{
    if (!is_on_path("ffmpeg"))
        throw InvalidInput(file.string() + ": a video needs the program ffmpeg on PATH; install it "
                                           "(apt install ffmpeg) or write a .png");
}

VideoWriter::VideoWriter(std::filesystem::path file, int width, int height, double fps)
    : file_(std::move(file)),
      partial_(file_.parent_path() / (file_.stem().string() + ".partial" + file_.extension().string())),
      width_(width), height_(height)
{
    if (file_.extension() != ".mp4")
        throw InvalidInput(file_.string() + ": videos are written as MP4; name it .mp4");
    if (width < 2 || height < 2 || !(fps > 0.0))
        throw InvalidInput(file_.string() + ": " + std::to_string(width) + " x " + std::to_string(height) +
                           " pixels at " + std::to_string(fps) +
                           " fps make no video; use 2 x 2 or more and a positive rate");
    require_encoder(file_);
    write_atomically(partial_, "");

    std::ostringstream rate;
    rate << fps;
    pipe_ = spawn_reader({"ffmpeg",
                          "-loglevel",
                          "error",
                          "-y",
                          "-f",
                          "rawvideo",
                          "-pix_fmt",
                          "rgb24",
                          "-s",
                          std::to_string(width) + "x" + std::to_string(height),
                          "-r",
                          rate.str(),
                          "-i",
                          "-",
                          "-vf",
                          "crop=trunc(iw/2)*2:trunc(ih/2)*2",
                          "-c:v",
                          "libx264",
                          "-crf",
                          "18",
                          "-pix_fmt",
                          "yuv420p",
                          "-movflags",
                          "+faststart",
                          partial_.string()},
                         process_);
    if (!pipe_)
        throw DeviceError(file_.string() + ": ffmpeg can't be started");
}

VideoWriter::~VideoWriter()
{
    const IgnoreBrokenPipe guard;
    if (pipe_) {
        std::fclose(pipe_);
        ::waitpid(process_, nullptr, 0);
    }
}

void VideoWriter::write(const Image& image)
{
    if (image.width != width_ || image.height != height_)
        throw InvalidInput(file_.string() + ": a picture is " + std::to_string(image.width) + " x " +
                           std::to_string(image.height) + " pixels, the video " + std::to_string(width_) +
                           " x " + std::to_string(height_) + "; all must be of one size");
    const IgnoreBrokenPipe guard;
    if (!pipe_ || std::fwrite(image.rgb.data(), 1, image.rgb.size(), pipe_) != image.rgb.size())
        throw DeviceError(file_.string() + ": ffmpeg stopped taking pictures; its message stands above");
}

void VideoWriter::finish()
{
    const IgnoreBrokenPipe guard;
    const bool flushed = pipe_ && std::fclose(std::exchange(pipe_, nullptr)) == 0;
    int status = -1;
    ::waitpid(process_, &status, 0);
    if (!flushed || status != 0)
        throw DeviceError(file_.string() + ": ffmpeg failed; its message stands above, what it wrote is " +
                          partial_.string());
    std::filesystem::rename(partial_, file_);
}

} // namespace toile::preview
