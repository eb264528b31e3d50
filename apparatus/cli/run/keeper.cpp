#include "apparatus/cli/run/keeper.hpp"

#include <algorithm>

#include "apparatus/run/machine/stopwatch.hpp"
#include "libmpm/io/write_error.hpp"

namespace tremie::cli {
namespace {

/// A large body's checkpoint may take seconds: of a run it takes no more than one part in so many.
constexpr double least_share = 100.0;

double seconds(std::chrono::steady_clock::duration d) { return std::chrono::duration<double>(d).count(); }

}  // namespace

Keeper::Keeper(const std::filesystem::path& folder, double interval, const report::RunRequest& request,
               const std::optional<report::Checkpoint>& from)
    : interval_(interval), request_(request), start_(Clock::now()), last_(start_) {
  attempt([&] {
    writer_ = from ? std::make_unique<report::CheckpointWriter>(folder, from->frames_length, from->frames_sum)
                   : std::make_unique<report::CheckpointWriter>(folder);
  });
  checkpoints_.due = [this] { return is_due(); };
  checkpoints_.keep = [this](const VisitState& state) { keep(state); };
  checkpoints_.keep_for_longer = [this](const VisitState& state) { keep_for_longer(state); };
  if (from) checkpoints_.restore = [from = *from](const VisitState& state) { report::restore(from, state); };
}

template <class Write>
void Keeper::attempt(Write write) {
  try {
    write();
  } catch (const io::WriteError& error) {
    trouble_ = std::string("no further checkpoint: ") + error.what();
    writer_.reset();
  }
}

void Keeper::frame(const Frame& frame) {
  if (writer_) attempt([&] { writer_->frame(frame); });
}

bool Keeper::is_due() const {
  const double wait = interval_ < 1.0 ? interval_ : std::max(interval_, least_share * cost_);
  return writer_ && seconds(Clock::now() - last_) >= wait;
}

/// With what the run took so far.
report::RunRequest Keeper::request_now() const {
  report::RunRequest request = request_;
  request.wall += seconds(Clock::now() - start_);
  request.cpu += cpu_seconds();
  return request;
}

void Keeper::keep_for_longer(const VisitState& state) {
  if (writer_) attempt([&] { writer_->end(request_now(), state); });
}

void Keeper::keep(const VisitState& state) {
  if (!writer_) return;
  const auto begin = Clock::now();
  attempt([&] { writer_->state(request_now(), state); });
  last_ = Clock::now();
  cost_ = seconds(last_ - begin);
}

}  // namespace tremie::cli
