// The programs raywalk_png_jpeg and raywalk_openimageio: decode or encode one picture. Standard input is the file or
// the samples, standard output the reply. Not for the command line: helper_process.cpp runs them.
//   decode FORMAT PIXELS MEMORY_BYTES OUTPUT_BYTES SECONDS
//   encode FORMAT WIDTH HEIGHT urgent|unhurried          (into the open file `encoded_file`)
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <new>
#include <string>
#include <system_error>

#include "helpers/image/codecs.h"
#include "tracer/files/image/helper_process.h"
#include "tracer/ground/sanitized.h"

namespace raywalk {

namespace {

void limit(int resource, std::uint64_t most) {
    if (most == 0) return;
    const rlimit both{most, most};
    setrlimit(static_cast<__rlimit_resource>(resource), &both);
}

// The picture, without a copy of it: as little memory and time as can be.
class Input {
  public:
    Input() {
        struct stat status {};
        if (fstat(STDIN_FILENO, &status) != 0 || status.st_size == 0) return;
        size_ = static_cast<std::size_t>(status.st_size);
        data_ = mmap(nullptr, size_, PROT_READ, MAP_SHARED, STDIN_FILENO, 0);
        if (data_ == MAP_FAILED) throw std::bad_alloc();
    }
    ~Input() {
        if (size_ > 0) munmap(data_, size_);
    }
    Input(const Input&) = delete;
    Input& operator=(const Input&) = delete;
    [[nodiscard]] std::string_view bytes() const { return {static_cast<const char*>(data_), size_}; }

  private:
    void* data_ = nullptr;
    std::size_t size_ = 0;
};

// Bytes of data that this process has: its libraries', their threads' stacks. 0 where /proc does not say.
std::uint64_t memory_in_use() {
    std::ifstream statistics("/proc/self/statm");
    std::uint64_t size = 0, resident = 0, shared = 0, text = 0, library = 0, data = 0;
    statistics >> size >> resident >> shared >> text >> library >> data;
    return statistics ? data * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)) : 0;
}

// The memory that this process may take beside what it had `before`: `memory_bytes` and that of so many pixels, now or
// when it allows itself more.
void limit_memory(std::uint64_t before, std::uint64_t memory_bytes, std::uint64_t pixels, std::uint64_t most_pixels) {
    if (memory_bytes == 0 || RAYWALK_SANITIZED) return;  // sanitizers map memory of their own
    const auto with = [&](std::uint64_t count) { return before + memory_bytes + memory_of_a_pixel * count; };
    const rlimit both{with(std::min(pixels, most_pixels)), with(most_pixels)};
    setrlimit(RLIMIT_DATA, &both);
}

bool write_all(const void* data, std::size_t size) {
    const char* at = static_cast<const char*>(data);
    while (size > 0) {
        const ssize_t count = write(STDOUT_FILENO, at, size);
        if (count <= 0) return false;
        at += count;
        size -= static_cast<std::size_t>(count);
    }
    return true;
}

int answer(ImageReply::Status status, std::uint64_t width, std::uint64_t height, const void* body, std::size_t size,
           std::uint32_t clipped = 0) {
    const ImageReply reply{ImageReply::magic_number, status, static_cast<std::uint32_t>(width),
                           static_cast<std::uint32_t>(height), clipped};
    return write_all(&reply, sizeof reply) && write_all(body, size) ? 0 : 1;
}

int answer_failure(const std::string& reason) {
    constexpr std::size_t longest = 300;  // bytes of a reason
    return answer(ImageReply::failed, 0, 0, reason.data(), std::min(reason.size(), longest));
}

int decode(ImageFormat format, std::string_view input, std::uint64_t most_pixels, std::uint64_t memory_bytes) {
    // Until the header is read, and for a small picture always: a damaged one may want gigabytes for a few pixels.
    constexpr std::uint64_t few_pixels = 1 << 22;
    use_one_thread();  // before memory is counted: libraries have started their threads, one for each core, by now
    const std::uint64_t before = memory_in_use();
    limit_memory(before, memory_bytes, few_pixels, most_pixels);
    std::uint64_t width = 0, height = 0;
    bool too_large = false;
    const ImageRefusal refusal = [&](std::uint64_t w, std::uint64_t h) -> std::string {
        width = w;
        height = h;
        too_large = w * h > most_pixels;
        if (!too_large) limit_memory(before, memory_bytes, std::max(w * h, few_pixels), most_pixels);
        return too_large ? "too large" : "";
    };
    Image image;
    const std::string problem = decode_pixels(format, {input.data(), input.size()}, refusal, image);
    if (too_large) return answer(ImageReply::too_large, width, height, nullptr, 0);
    if (!problem.empty()) return answer_failure(problem);
    return answer(ImageReply::done, static_cast<std::uint64_t>(image.width), static_cast<std::uint64_t>(image.height),
                  image.texels.data(), image.texels.size() * sizeof image.texels[0], image.clipped);
}

// Samples from standard input, as many as fill `to`.
bool read_samples(std::span<std::byte> to) {
    while (!to.empty()) {
        const ssize_t count = read(STDIN_FILENO, to.data(), to.size());
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return false;
        to = to.subspan(static_cast<std::size_t>(count));
    }
    return true;
}

int encode(const ImageEncoding& picture) {
    std::signal(SIGXFSZ, SIG_IGN);  // a file that grows past its limit is an error of writing
    EncodedFile file(encoded_file);
    std::string problem = encode_picture(picture, read_samples, file);
    if (!file.flush()) problem = std::generic_category().message(file.error());
    if (!problem.empty()) return answer_failure(problem);
    return answer(ImageReply::done, static_cast<std::uint64_t>(picture.width),
                  static_cast<std::uint64_t>(picture.height), nullptr, 0);
}

int run(int count, char** words) {
    const std::string task = count > 1 ? words[1] : "";
    const auto number = [&](int i) { return std::strtoull(words[i], nullptr, 10); };
    if (!(task == "decode" && count == 7) && !(task == "encode" && count == 6)) {
        std::fputs("raywalk runs this program for each picture that it reads or writes\n", stderr);
        return 2;
    }
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // nobody would take the picture
    const auto format = static_cast<ImageFormat>(number(2));
    if (task == "decode") {
        limit(RLIMIT_CORE, 1);
        if (!RAYWALK_SANITIZED) limit(RLIMIT_FSIZE, number(5));  // sanitizers write down what ran
        limit(RLIMIT_CPU, number(6));
    }
    try {
        if (task == "encode")
            return encode(
                {format, static_cast<int>(number(3)), static_cast<int>(number(4)), std::string(words[5]) == "urgent"});
        const Input input;
        return decode(format, input.bytes(), number(3), number(4));
    } catch (const std::bad_alloc&) {
        return answer_failure("it needs too much memory");
    } catch (const std::exception& error) {
        return answer_failure(error.what());
    }
}

}  // namespace

}  // namespace raywalk

int main(int count, char** words) {
    const int code = raywalk::run(count, words);
    if (RAYWALK_SANITIZED) return code;  // leaks are looked for at a usual end
    std::_Exit(code);                    // nothing is left to say, and 260 libraries have a lot to tidy up
}
