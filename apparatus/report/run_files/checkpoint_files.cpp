#include "apparatus/report/run_files/checkpoint_files.hpp"

#include <fmt/format.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <memory>
#include <optional>
#include <vector>

#include "apparatus/scene/input_error.hpp"
#include "libmpm/io/write_error.hpp"
#include "tremie_version.hpp"

namespace tremie::report {

void visit(Archive& archive, RunRequest& request) {
  archive(request.name, request.resolved, request.command, request.accuracy, request.with_error,
          request.crate, request.threads, request.wall, request.cpu);
}

namespace {

namespace fs = std::filesystem;

/// A frame in single precision, as results.h5 and the frames for ParaView have it: half of the bytes.
struct SingleFrame {
  double time = 0.0;
  std::vector<std::array<float, 3>> position, velocity;
  std::vector<float> volume, pressure, shear_rate, flocculation, age, load;
};

void visit(Archive& archive, SingleFrame& frame) {
  archive(frame.time, frame.position, frame.velocity, frame.volume, frame.pressure, frame.shear_rate,
          frame.flocculation, frame.age, frame.load);
}

template <class To, class From>
std::vector<std::array<To, 3>> converted(const std::vector<std::array<From, 3>>& from) {
  std::vector<std::array<To, 3>> to;
  to.reserve(from.size());
  for (const auto& x : from)
    to.push_back({static_cast<To>(x[0]), static_cast<To>(x[1]), static_cast<To>(x[2])});
  return to;
}
template <class To, class From>
std::vector<To> converted(const std::vector<From>& from) {
  std::vector<To> to(from.size());
  std::transform(from.begin(), from.end(), to.begin(), [](From x) { return static_cast<To>(x); });
  return to;
}
template <class To, class Number, class From>
To frame_as(const From& from) {
  return {from.time,
          converted<Number>(from.position),
          converted<Number>(from.velocity),
          converted<Number>(from.volume),
          converted<Number>(from.pressure),
          converted<Number>(from.shear_rate),
          converted<Number>(from.flocculation),
          converted<Number>(from.age),
          converted<Number>(from.load)};
}

constexpr std::array<char, 8> magic{'T', 'R', 'E', 'M', 'I', 'E', 'C', '1'};

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

File open_file(const fs::path& path, const char* mode) {
  errno = 0;
  return {std::fopen(path.c_str(), mode), std::fclose};
}

std::uint32_t sum_with(std::uint32_t sum, const void* data, std::size_t n) {
  return static_cast<std::uint32_t>(crc32_z(sum, static_cast<const Bytef*>(data), n));
}

void write_or_throw(const void* data, std::size_t n, std::FILE* file, const fs::path& path) {
  if (std::fwrite(data, 1, n, file) != n) io::fail_to_write(path);
}

/// On the disk, not in the system's memory alone.
void bring_to_disk(std::FILE* file, const fs::path& path) {
  errno = 0;
  if (std::fflush(file) != 0 || (fsync(fileno(file)) != 0 && errno != EINVAL)) io::fail_to_write(path);
}

/// Writes, and adds to the sum and the length.
Archive writer(std::FILE* file, const fs::path& path, std::uint64_t& length, std::uint32_t& sum) {
  return Archive([file, &path, &length, &sum](const void* data, std::size_t n) {
    write_or_throw(data, n, file, path);
    sum = sum_with(sum, data, n);
    length += n;
  });
}

Archive reader(std::FILE* file, std::uint64_t left) {
  return {[file](void* data, std::size_t n) {
            if (std::fread(data, 1, n, file) != n) throw std::length_error("the file is cut");
          },
          left};
}

/// Which program wrote it: a state is bytes as they lie in memory.
std::string program() { return fmt::format("{} {} {} {}", version, commit, compiler, instructions); }

[[noreturn]] void refuse_to_resume(const fs::path& folder, const std::string& why) {
  throw scene::InputError(fmt::format("{}: {}; `tremie run` with --force begins anew", folder.string(), why));
}

/// The sum over the first `length` bytes of a file; empty where it has no so many.
std::optional<std::uint32_t> sum_of(const fs::path& path, std::uint64_t length) {
  const File file = open_file(path, "rb");
  if (!file) return std::nullopt;
  std::vector<char> block(1 << 20);
  std::uint32_t sum = 0;
  while (length > 0) {
    const std::size_t n = static_cast<std::size_t>(std::min<std::uint64_t>(length, block.size()));
    if (std::fread(block.data(), 1, n, file.get()) != n) return std::nullopt;
    sum = sum_with(sum, block.data(), n);
    length -= n;
  }
  return sum;
}

std::uint64_t size_of(const fs::path& path) {
  std::error_code error;
  const auto size = fs::file_size(path, error);
  return error ? 0 : size;
}

constexpr std::size_t sum_size = sizeof(std::uint32_t);

/// Writes a state with what it was asked and the length and sum of its frames; `at_once`: it is on the disk then.
void write_state(const fs::path& path, bool at_once, RunRequest request, std::uint64_t frames_length,
                 std::uint32_t frames_sum, const VisitState& state) {
  const fs::path part = path.string() + ".part";
  {
    const File file = open_file(part, "wb");
    if (!file) io::fail_to_write(part);
    std::uint64_t length = 0;
    std::uint32_t sum = 0;
    Archive archive = writer(file.get(), part, length, sum);
    std::array<char, 8> begin = magic;
    std::string written_by = program();
    archive(begin, written_by, request, frames_length, frames_sum);
    state(archive);
    write_or_throw(&sum, sum_size, file.get(), part);
    if (at_once)
      bring_to_disk(file.get(), part);
    else if (std::fflush(file.get()) != 0)
      io::fail_to_write(part);
  }
  std::error_code error;
  fs::rename(part, path, error);
  if (error) io::fail_to_write(path);
}

/// Whether the file ends with the sum over all before.
bool is_whole(const fs::path& path) {
  const std::uint64_t size = size_of(path);
  if (size < magic.size() + sum_size) return false;
  const auto sum = sum_of(path, size - sum_size);
  std::uint32_t written = 0;
  const File file = open_file(path, "rb");
  return sum && file && std::fseek(file.get(), -static_cast<long>(sum_size), SEEK_END) == 0 &&
         std::fread(&written, 1, sum_size, file.get()) == sum_size && written == *sum;
}

}  // namespace

CheckpointWriter::CheckpointWriter(const fs::path& folder, std::uint64_t length, std::uint32_t sum)
    : folder_(folder), length_(length), sum_(sum), frames_(nullptr) {
  std::error_code error;
  fs::create_directories(folder, error);
  const fs::path path = folder / "frames";
  if (length > 0) fs::resize_file(path, length, error);
  frames_ = std::fopen(path.c_str(), length > 0 ? "ab" : "wb");
  if (!frames_ || error) io::fail_to_write(path);
}

CheckpointWriter::~CheckpointWriter() {
  if (frames_) std::fclose(frames_);
}

void CheckpointWriter::frame(const Frame& frame) {
  const fs::path path = folder_ / "frames";
  Archive archive = writer(frames_, path, length_, sum_);
  auto single = frame_as<SingleFrame, float>(frame);
  archive(single);
}

void CheckpointWriter::state(const RunRequest& request, const VisitState& state) {
  bring_to_disk(frames_, folder_ / "frames");
  write("state", true, request, state);
}

void CheckpointWriter::end(const RunRequest& request, const VisitState& state) {
  write("end", false, request, state);
}

void CheckpointWriter::write(const char* name, bool at_once, const RunRequest& request,
                             const VisitState& state) {
  write_state(folder_ / name, at_once, request, length_, sum_, state);
}

Checkpoint read_checkpoint(const fs::path& folder) {
  const fs::path path = folder / "state";
  if (!is_whole(path)) refuse_to_resume(folder, "the checkpoint is damaged or cut");
  const File file = open_file(path, "rb");
  Archive archive = reader(file.get(), size_of(path) - sum_size);
  Checkpoint checkpoint{folder, {}};
  std::array<char, 8> begin{};
  std::string written_by;
  try {
    archive(begin);
    if (begin == magic) archive(written_by);
    if (written_by != program())
      refuse_to_resume(folder,
                       fmt::format("the checkpoint is of another version of tremie ({})", written_by));
    archive(checkpoint.request, checkpoint.frames_length, checkpoint.frames_sum);
  } catch (const std::length_error&) {
    refuse_to_resume(folder, "the checkpoint is damaged or cut");
  }
  checkpoint.state_at = static_cast<std::uint64_t>(std::ftell(file.get()));
  if (sum_of(folder / "frames", checkpoint.frames_length) != checkpoint.frames_sum)
    refuse_to_resume(folder, "the checkpoint's frames are damaged or cut");
  return checkpoint;
}

void keep_for_longer(const fs::path& checkpoint, const fs::path& folder) {
  std::error_code error, ignored;
  if (!fs::exists(checkpoint / "end", ignored)) return;
  fs::create_directory(folder, error);
  if (!error) fs::create_hard_link(checkpoint / "frames", folder / "frames", error);
  if (error) fs::copy_file(checkpoint / "frames", folder / "frames", error);
  if (!error) fs::rename(checkpoint / "end", folder / "state", error);
  if (error) fs::remove_all(folder, ignored);
}

void ask_for_longer(const Checkpoint& checkpoint, const RunRequest& request) {
  const fs::path path = checkpoint.folder / "state";
  constexpr std::size_t block = 4096;
  const std::size_t size = size_of(path) - sum_size - checkpoint.state_at;
  std::vector<std::array<char, block>> blocks(size / block);
  std::vector<char> rest(size % block);
  const VisitState as_it_stands = [&](Archive& archive) {
    for (auto& bytes : blocks) archive(bytes);
    for (char& byte : rest) archive(byte);
  };
  restore(checkpoint, as_it_stands);
  write_state(path, true, request, checkpoint.frames_length, checkpoint.frames_sum, as_it_stands);
}

void remove_checkpoint(const fs::path& folder) {
  std::error_code ignored;
  fs::remove(folder / "state", ignored);
  fs::remove_all(folder, ignored);
}

void restore(const Checkpoint& checkpoint, const VisitState& state) {
  const fs::path path = checkpoint.folder / "state";
  const File file = open_file(path, "rb");
  if (!file || std::fseek(file.get(), static_cast<long>(checkpoint.state_at), SEEK_SET) != 0)
    refuse_to_resume(checkpoint.folder, "the checkpoint cannot be read");
  Archive archive = reader(file.get(), size_of(path) - sum_size - checkpoint.state_at);
  state(archive);
}

void for_each_frame(const Checkpoint& checkpoint, const std::function<void(const Frame&)>& use) {
  const File file = open_file(checkpoint.folder / "frames", "rb");
  if (!file) refuse_to_resume(checkpoint.folder, "the checkpoint's frames cannot be read");
  while (static_cast<std::uint64_t>(std::ftell(file.get())) < checkpoint.frames_length) {
    Archive archive =
        reader(file.get(), checkpoint.frames_length - static_cast<std::uint64_t>(std::ftell(file.get())));
    SingleFrame frame;
    archive(frame);
    use(frame_as<Frame, double>(frame));
  }
}

}  // namespace tremie::report
