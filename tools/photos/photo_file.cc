#include "tools/photos/photo_file.h"

#include <dlfcn.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <system_error>
#include <utility>

#include "tools/photos/photo_codecs.h"

namespace lodemark {
namespace {

constexpr std::int64_t kLargestFile_bytes = 512LL << 20;
constexpr std::int64_t kLargestPhoto_px = 200'000'000;

// The codecs in the lib folder beside the program's own. Not left to the program's RUNPATH, which
// the loader does not ask when a sanitizer calls it on our behalf.
void* OpenBesideProgram() {
  std::error_code failed;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", failed);
  if (failed) return nullptr;
  const std::filesystem::path beside =
      program.parent_path().parent_path() / "lib" / LODEMARK_PHOTO_CODECS;
  return dlopen(beside.c_str(), RTLD_NOW | RTLD_LOCAL);
}

// The codecs, loaded once and kept until the program ends.
Result<const PhotoCodecs*> LoadCodecs() {
  static const Result<const PhotoCodecs*> loaded = []() -> Result<const PhotoCodecs*> {
    const auto missing = [] {
      const char* reason = dlerror();
      return Error{ErrorCode::kIo, std::string("photographs cannot be read: ") +
                                       (reason == nullptr ? "no reason given" : reason) +
                                       "; is OpenCV's imgcodecs installed?"};
    };
    void* library = OpenBesideProgram();
    // Installed elsewhere, the loader's own search finds it.
    if (library == nullptr) library = dlopen(LODEMARK_PHOTO_CODECS, RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) return missing();
    void* symbol = dlsym(library, kPhotoCodecsSymbol);
    if (symbol == nullptr) return missing();
    return reinterpret_cast<const PhotoCodecs* (*)()>(symbol)();
  }();
  return loaded;
}

struct FileCloser {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

Result<std::vector<std::uint8_t>> ReadBytes(const std::string& path) {
  struct stat status = {};
  if (::stat(path.c_str(), &status) != 0) {
    return Error{ErrorCode::kIo, path + ": cannot open: " + std::strerror(errno) +
                                     "; check its name and permissions"};
  }
  if (S_ISDIR(status.st_mode)) {
    return Error{ErrorCode::kIo, path + ": is a directory; name a photograph in it"};
  }
  const std::unique_ptr<std::FILE, FileCloser> file(std::fopen(path.c_str(), "rb"));
  if (file == nullptr) {
    return Error{ErrorCode::kIo, path + ": cannot open: " + std::strerror(errno) +
                                     "; check its name and permissions"};
  }
  std::vector<std::uint8_t> bytes;
  std::vector<std::uint8_t> block(1 << 20);
  while (const std::size_t got = std::fread(block.data(), 1, block.size(), file.get())) {
    bytes.insert(bytes.end(), block.begin(), block.begin() + static_cast<std::ptrdiff_t>(got));
    if (static_cast<std::int64_t>(bytes.size()) > kLargestFile_bytes) {
      return Error{ErrorCode::kUnsupported, path + ": is above 512 MB; name a photograph"};
    }
  }
  if (std::ferror(file.get()) != 0) {
    return Error{ErrorCode::kIo, path + ": cannot be read: " + std::strerror(errno)};
  }
  if (bytes.empty()) {
    return Error{ErrorCode::kBadData, path + ": the file is empty; name a photograph"};
  }
  return bytes;
}

}  // namespace

Result<Photo> ReadPhoto(const std::string& path) {
  const Result<std::vector<std::uint8_t>> bytes = ReadBytes(path);
  if (!bytes) return bytes.error();
  const Result<const PhotoCodecs*> codecs = LoadCodecs();
  if (!codecs) return codecs.error();
  Photo photo;
  photo.path = path;
  std::string reason;
  if (!(*codecs)->decode_grey(bytes->data(), bytes->size(), kLargestPhoto_px, &photo.width_px,
                              &photo.height_px, &photo.pixels, &reason)) {
    return Error{ErrorCode::kBadData, path + ": " + reason};
  }
  return photo;
}

Result<std::string> EncodePicture(const Picture& picture, std::string_view path, int jpeg_quality) {
  std::string ending;
  for (const char* known : {".png", ".jpg", ".jpeg"}) {
    if (path.ends_with(known)) ending = known;
  }
  if (ending.empty()) {
    return Error{ErrorCode::kInvalidArgument,
                 std::string(path) + ": name a .png or .jpg to draw into"};
  }
  const Result<const PhotoCodecs*> codecs = LoadCodecs();
  if (!codecs) return codecs.error();
  std::vector<std::uint8_t> bytes;
  std::string reason;
  if (!(*codecs)->encode_colour(ending.c_str(), picture.pixels.data(), picture.width_px,
                                picture.height_px, jpeg_quality, &bytes, &reason)) {
    return Error{ErrorCode::kInternal, std::string(path) + ": " + reason};
  }
  return std::string(bytes.begin(), bytes.end());
}

}  // namespace lodemark
