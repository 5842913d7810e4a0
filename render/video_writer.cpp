// SPDX-License-Identifier: MIT
// Runs ffmpeg with raw pictures on its standard input. The input is a socket rather than a pipe, because a send can be
// told not to raise SIGPIPE when ffmpeg has gone; ffmpeg's messages go to an unnamed file, which can never block it.
#include "render/video_writer.h"

#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <string>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <talus/types.h>

#include "render/partial_file.h"

extern char** environ;

namespace talus::render {

namespace {

class FileDescriptor {
public:
    FileDescriptor() = default;
    explicit FileDescriptor(int opened) : value(opened) {}
    ~FileDescriptor() { close(); }
    FileDescriptor(const FileDescriptor&) = delete;
    FileDescriptor& operator=(const FileDescriptor&) = delete;

    void close() {
        if (value >= 0) ::close(value);
        value = -1;
    }

    int value = -1;
};

/// The last lines of what ffmpeg said.
std::string read_messages(std::FILE* messages) {
    constexpr long k_most = 2000;
    std::fseek(messages, 0, SEEK_END);
    const long size = std::ftell(messages);
    std::fseek(messages, size > k_most ? size - k_most : 0, SEEK_SET);
    std::string text(static_cast<std::size_t>(k_most), '\0');
    text.resize(std::fread(text.data(), 1, text.size(), messages));
    while (!text.empty() && (text.back() == '\n' || text.back() == ' '))
        text.pop_back();
    return text;
}

} // namespace

struct VideoWriter::Impl {
    Impl(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height, double rate)
        : file(path), frame_width(width), frame_height(height), frames_per_second(rate) {}

    ~Impl() {
        pictures.close();
        if (process > 0) {
            kill(process, SIGKILL);
            wait();
        }
    }

    void start();
    int wait();
    [[noreturn]] void give_up();
    Error error(const std::string& reason) const {
        return Error("cannot write the video " + file.target().string() + ": " + reason);
    }

    PartialFile file;
    std::uint32_t frame_width, frame_height;
    double frames_per_second;
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> messages{nullptr, &std::fclose};
    FileDescriptor pictures;
    pid_t process = 0;
    std::uint64_t picture_count = 0;
};

void VideoWriter::Impl::start() {
    messages.reset(std::tmpfile());
    if (!messages) throw error(std::string("no temporary file: ") + std::strerror(errno));
    std::array<int, 2> ends{-1, -1};
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
        throw error(std::string("no socket: ") + std::strerror(errno));
    pictures.value = ends[0];
    const FileDescriptor input(ends[1]);

    const std::string size = std::to_string(frame_width) + "x" + std::to_string(frame_height);
    // "file:" keeps names that look like an option or an address from being taken for one.
    std::vector<std::string> words{
        "ffmpeg", "-hide_banner", "-loglevel", "error", "-f", "rawvideo", "-pixel_format", "rgb24", "-video_size", size,
        "-framerate", std::to_string(frames_per_second), "-i", "pipe:0", "-an",
        // Players take high-definition video for BT.709; ffmpeg on its own would convert to BT.601.
        "-vf", "scale=out_color_matrix=bt709:out_range=tv", "-colorspace", "bt709", "-color_primaries", "bt709",
        "-color_trc", "bt709", "-c:v", "libx264", "-preset", "veryfast", "-crf", "18", "-pix_fmt", "yuv420p",
        "-movflags", "+faststart", "-f", "mp4", "-y", "file:" + file.temporary().string()};
    std::vector<char*> arguments;
    for (std::string& word : words)
        arguments.push_back(word.data());
    arguments.push_back(nullptr);

    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, input.value, STDIN_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, fileno(messages.get()), STDERR_FILENO);
    const int failure = posix_spawnp(&process, "ffmpeg", &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failure != 0) {
        process = 0;
        if (failure == ENOENT)
            throw error(
                "the program ffmpeg is not there; install it (Debian: apt install ffmpeg), or ask for a picture "
                "instead of a video");
        throw error(std::string("the program ffmpeg does not start: ") + std::strerror(failure));
    }
}

int VideoWriter::Impl::wait() {
    int status = 0;
    while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
    }
    process = 0;
    return status;
}

void VideoWriter::Impl::give_up() {
    pictures.close();
    const int status = process > 0 ? wait() : 0;
    const std::string said = read_messages(messages.get());
    if (!said.empty()) throw error("ffmpeg says: " + said);
    if (WIFSIGNALED(status)) throw error("ffmpeg was ended by signal " + std::to_string(WTERMSIG(status)));
    throw error("ffmpeg ended early, with status " + std::to_string(WEXITSTATUS(status)));
}

VideoWriter::VideoWriter(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height,
                         double frames_per_second)
    : impl_(std::make_unique<Impl>(path, width, height, frames_per_second)) {
    if (width == 0 || height == 0 || width % 2 != 0 || height % 2 != 0)
        throw impl_->error("its size is " + std::to_string(width) + " x " + std::to_string(height) +
                           "; width and height must be even and not 0");
    if (!std::isfinite(frames_per_second) || frames_per_second <= 0.0)
        throw impl_->error("its rate is " + std::to_string(frames_per_second) +
                           " frames a second; it must be finite and more than 0");
    const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
    std::error_code ignored;
    if (!std::filesystem::is_directory(folder, ignored))
        throw impl_->error("the folder " + folder.string() + " does not exist");
    impl_->start();
}

VideoWriter::~VideoWriter() = default;

void VideoWriter::add(const Picture& picture) {
    if (impl_->process <= 0) throw impl_->error("it is finished already");
    if (picture.width != impl_->frame_width || picture.height != impl_->frame_height ||
        picture.rgb.size() != std::size_t{3} * picture.width * picture.height)
        throw impl_->error("a picture of " + std::to_string(picture.width) + " x " + std::to_string(picture.height) +
                           " does not fit into a video of " + std::to_string(impl_->frame_width) + " x " +
                           std::to_string(impl_->frame_height));
    std::size_t sent = 0;
    while (sent < picture.rgb.size()) {
        const ssize_t count =
            send(impl_->pictures.value, picture.rgb.data() + sent, picture.rgb.size() - sent, MSG_NOSIGNAL);
        if (count >= 0)
            sent += static_cast<std::size_t>(count);
        else if (errno != EINTR)
            impl_->give_up();
    }
    ++impl_->picture_count;
}

void VideoWriter::finish() {
    if (impl_->process <= 0) throw impl_->error("it is finished already");
    if (impl_->picture_count == 0) throw impl_->error("no picture was added to it");
    impl_->pictures.close();
    const int status = impl_->wait();
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
        const std::string said = read_messages(impl_->messages.get());
        throw impl_->error(said.empty() ? "ffmpeg failed without a word" : "ffmpeg says: " + said);
    }
    impl_->file.commit();
}

} // namespace talus::render
