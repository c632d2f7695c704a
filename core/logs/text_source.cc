#include "core/logs/text_source.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <system_error>
#include <utility>
#include <vector>

namespace lodemark {
namespace {

constexpr std::size_t kInputSize = 128 * 1024;
constexpr int kGzipWindowBits = 15 + 16;  // zlib: largest window, gzip framing only

bool IsGzip(std::string_view bytes) { return bytes.starts_with("\x1F\x8B"); }

Error IoError(const std::string& path, std::string_view what, int error_number) {
  return {ErrorCode::kIo,
          path + ": " + std::string(what) + ": " + std::generic_category().message(error_number)};
}

// A descriptor closed with its owner.
class File {
 public:
  explicit File(int descriptor) : descriptor_(descriptor) {}
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

// An inflating zlib stream that may not be moved, as zlib keeps its address.
class Inflater {
 public:
  Inflater() { ready_ = inflateInit2(&stream_, kGzipWindowBits) == Z_OK; }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;
  ~Inflater() {
    if (ready_) inflateEnd(&stream_);
  }
  bool ready() const { return ready_; }
  z_stream* stream() { return &stream_; }

 private:
  z_stream stream_ = {};
  bool ready_ = false;
};

}  // namespace

struct TextSource::Impl {
  std::string name;
  Status status;
  std::int64_t size = 0;
  std::int64_t taken = 0;  // raw bytes handed out, or to zlib

  std::unique_ptr<File> file;  // null for a memory source
  std::vector<char> input;     // what was read of the file and not yet taken is `pending`
  std::string_view pending;    // for a memory source all that is left
  bool at_end = false;         // of the file

  std::unique_ptr<Inflater> inflater;  // null for plain text
  bool between_members = false;        // a gzip member has ended
  std::int64_t unpacked = 0;

  void Fail(ErrorCode code, std::string_view what) {
    if (status.ok()) status = Error{code, name + ": " + std::string(what)};
  }

  // Makes pending non-empty. False at the end or on error.
  bool FillPending() {
    if (!pending.empty()) return true;
    if (file == nullptr || at_end || !status.ok()) return false;
    const std::size_t got = ReadFile(input.data(), input.size());
    pending = {input.data(), got};
    return got > 0;
  }

  std::size_t ReadFile(char* room, std::size_t room_size) {
    ssize_t got = -1;
    do {
      got = ::read(file->descriptor(), room, room_size);
    } while (got < 0 && errno == EINTR);
    if (got < 0 && status.ok()) status = IoError(name, "cannot read", errno);
    if (got <= 0) at_end = true;
    return got > 0 ? static_cast<std::size_t>(got) : 0;
  }

  std::size_t ReadPlain(char* room, std::size_t room_size) {
    std::size_t got = 0;
    if (!pending.empty()) {
      got = pending.copy(room, room_size);
      pending.remove_prefix(got);
    } else if (file != nullptr && !at_end) {
      got = ReadFile(room, room_size);
    }
    taken += static_cast<std::int64_t>(got);
    return got;
  }

  void Take(std::size_t count) {
    pending.remove_prefix(count);
    taken += static_cast<std::int64_t>(count);
  }

  // After the end of a gzip member: another member, padding with zeros, or nothing. False at the
  // end of it all.
  bool StartNextMember() {
    while (FillPending() && pending.front() == '\0') Take(1);
    if (pending.empty()) return false;
    if (pending.front() != '\x1F') {
      Fail(ErrorCode::kBadData,
           "bytes that are not gzip follow the compressed text; copy or download the file again");
      return false;
    }
    inflateReset(inflater->stream());
    between_members = false;
    return true;
  }

  std::size_t ReadGzip(char* room, std::size_t room_size) {
    z_stream& stream = *inflater->stream();
    const auto most = static_cast<std::size_t>(std::numeric_limits<uInt>::max());
    while (status.ok()) {
      if (between_members && !StartNextMember()) return 0;
      if (!FillPending()) {
        Fail(ErrorCode::kBadData, "the gzip data is cut short after " + std::to_string(unpacked) +
                                      " bytes of text; copy or download the file again");
        return 0;
      }
      const std::size_t offered = std::min(pending.size(), most);
      // zlib's interface lacks const; it only reads from next_in.
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(pending.data()));
      stream.avail_in = static_cast<uInt>(offered);
      stream.next_out = reinterpret_cast<Bytef*>(room);
      stream.avail_out = static_cast<uInt>(std::min(room_size, most));
      const uInt room_before = stream.avail_out;
      const int verdict = inflate(&stream, Z_NO_FLUSH);
      Take(offered - stream.avail_in);
      const std::size_t got = room_before - stream.avail_out;
      unpacked += static_cast<std::int64_t>(got);
      if (verdict == Z_STREAM_END) {
        between_members = true;
      } else if (verdict == Z_MEM_ERROR) {
        Fail(ErrorCode::kOutOfMemory, "not enough memory to unpack gzip");
      } else if (verdict != Z_OK && verdict != Z_BUF_ERROR) {
        Fail(ErrorCode::kBadData, "the gzip data is corrupt after " + std::to_string(unpacked) +
                                      " bytes of text; copy or download the file again");
      }
      if (got > 0) return got;
    }
    return 0;
  }

  void StartIfGzip() {
    if (!IsGzip(pending)) return;
    inflater = std::make_unique<Inflater>();
    if (!inflater->ready()) Fail(ErrorCode::kOutOfMemory, "not enough memory to unpack gzip");
  }
};

TextSource::TextSource(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
TextSource::TextSource(TextSource&&) noexcept = default;
TextSource& TextSource::operator=(TextSource&&) noexcept = default;
TextSource::~TextSource() = default;

Result<TextSource> TextSource::Open(const std::string& path) {
  struct stat facts = {};
  if (::stat(path.c_str(), &facts) != 0) return IoError(path, "cannot open", errno);
  if (S_ISDIR(facts.st_mode)) {
    return Error{ErrorCode::kIo, path + ": is a directory; name a file in it"};
  }
  if (!S_ISREG(facts.st_mode) && !S_ISFIFO(facts.st_mode)) {
    return Error{ErrorCode::kIo, path + ": is neither a file nor a pipe"};
  }
  if (S_ISREG(facts.st_mode) && facts.st_size == 0) {
    return Error{ErrorCode::kBadData, path + ": the file is empty"};
  }
  auto impl = std::make_unique<Impl>();
  impl->file = std::make_unique<File>(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (impl->file->descriptor() < 0) return IoError(path, "cannot open", errno);
  impl->name = path;
  impl->size = S_ISREG(facts.st_mode) ? static_cast<std::int64_t>(facts.st_size) : 0;
  impl->input.resize(kInputSize);
  impl->FillPending();
  while (impl->pending.size() == 1 && !impl->at_end) {  // a pipe may give a byte at a time
    impl->pending = {impl->input.data(),
                     1 + impl->ReadFile(impl->input.data() + 1, kInputSize - 1)};
  }
  if (!impl->status.ok()) return impl->status.error();
  impl->StartIfGzip();
  return TextSource(std::move(impl));
}

TextSource TextSource::FromMemory(std::string name, std::string_view bytes) {
  auto impl = std::make_unique<Impl>();
  impl->name = std::move(name);
  impl->size = static_cast<std::int64_t>(bytes.size());
  impl->pending = bytes;
  impl->StartIfGzip();
  return TextSource(std::move(impl));
}

std::size_t TextSource::Read(char* room, std::size_t room_size) {
  if (room_size == 0 || !impl_->status.ok()) return 0;
  return impl_->inflater != nullptr ? impl_->ReadGzip(room, room_size)
                                    : impl_->ReadPlain(room, room_size);
}

bool TextSource::compressed() const { return impl_->inflater != nullptr; }
std::int64_t TextSource::size() const { return impl_->size; }
const std::string& TextSource::name() const { return impl_->name; }
const Status& TextSource::status() const { return impl_->status; }

double TextSource::progress() const {
  if (impl_->size <= 0) return 0.0;
  return std::min(1.0, static_cast<double>(impl_->taken) / static_cast<double>(impl_->size));
}

}  // namespace lodemark
