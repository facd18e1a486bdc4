#include "app/process/saving.h"

#include <unistd.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <new>
#include <string>
#include <system_error>

#include "tracer/files/image/image.h"
#include "tracer/ground/error.h"

namespace raywalk {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t reserve_bytes = std::size_t{8} << 20;

fs::path temporary_folder() {
    const char* folder = std::getenv("TMPDIR");
    return folder != nullptr && *folder != '\0' ? folder : "/tmp";
}

// Where the radiance went; empty where nothing can be written either. Nothing that is there is overwritten.
fs::path rescued(const fs::path& output, const Film& film) {
    const std::string name = "rescued-" + output.filename().string() + "-" + std::to_string(getpid()) + ".pfm";
    for (const fs::path& file : std::array{output.parent_path() / name, temporary_folder() / name}) try {
            std::error_code error;
            if (fs::exists(fs::symlink_status(file, error))) continue;
            write_image(file, radiance_rows(film), Saving::urgent);
            return file;
        } catch (const std::exception&) {  // the next place then
        }
    return {};
}

}  // namespace

SavingReserve::SavingReserve() : bytes_(new std::byte[reserve_bytes]) {
    std::memset(bytes_.get(), 1, reserve_bytes);  // the machine has to have it now
}

void save_or_rescue(const fs::path& output, const Film& film, SavingReserve& reserve,
                    const std::function<void()>& save) {
    reserve.release();
    std::string problem;
    try {
        return save();
    } catch (const WorkError& error) {
        problem = error.what();
    } catch (const std::bad_alloc&) {
        problem = "cannot write " + quoted_name(output.string()) + ": out of memory";
    } catch (const std::system_error& error) {  // no thread for it
        problem = "cannot write " + quoted_name(output.string()) + ": " + error.what();
    }
    const fs::path file = rescued(output, film);
    if (file.empty()) throw WorkError(problem);
    throw WorkError(problem + "\n  its radiance is saved as " + quoted_name(file.string()));
}

}  // namespace raywalk
