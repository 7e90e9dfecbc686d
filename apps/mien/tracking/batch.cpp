// Tracks all recordings of a folder with several threads.
#include "apps/mien/tracking/batch.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

#include "apps/mien/system/failure.h"
#include "apps/mien/system/json_text.h"
#include "apps/mien/system/out_of_memory.h"
#include "apps/mien/system/paths.h"
#include "apps/mien/system/printable.h"
#include "apps/mien/system/progress.h"

namespace mien::app {
namespace {

namespace fs = std::filesystem;

constexpr std::array kRecordings = {".3gp", ".aac", ".avi",  ".flac", ".flv", ".m4a",
                                    ".m4v", ".mkv", ".mov",  ".mp3",  ".mp4", ".mpeg",
                                    ".mpg", ".mts", ".oga",  ".ogg",  ".ogv", ".opus",
                                    ".ts",  ".wav", ".webm", ".wma",  ".wmv", ".y4m"};

enum class Outcome { kWaiting, kDone, kDoneBefore, kFailed };

struct Job {
  std::string input;
  std::string name;                  // within the folder
  std::vector<std::string> outputs;  // animations, then the report
  Outcome outcome = Outcome::kWaiting;
  TrackSummary summary;
  double seconds = 0.0;
  std::string failure;
};

const char* word(Outcome outcome) {
  switch (outcome) {
    case Outcome::kWaiting:
      return "waiting";
    case Outcome::kDone:
      return "done";
    case Outcome::kDoneBefore:
      return "done before";
    case Outcome::kFailed:
      return "failed";
  }
  return "";
}

std::vector<std::string> endings(const std::vector<std::string>& formats) {
  std::vector<std::string> made;
  for (const std::string& asked : formats.empty() ? std::vector<std::string>{"csv"} : formats) {
    const animation::AnimationFormat format = format_asked_for(asked);
    for (const animation::FormatName& known : animation::kFormatNames) {
      if (known.format == format) {
        made.emplace_back(known.ending);
      }
    }
  }
  return made;
}

bool done_before(const Job& job) {
  std::error_code error;
  const auto made = fs::last_write_time(path_of(job.input), error);
  return std::all_of(job.outputs.begin(), job.outputs.end(), [&](const std::string& output) {
    const auto written = fs::last_write_time(path_of(output), error);
    return !error && written >= made;
  });
}

std::vector<Job> find_jobs(const BatchOptions& options) {
  std::vector<std::string> wanted = endings(options.each.animation.formats);
  if (options.reports) {
    wanted.emplace_back(".html");
  }
  const fs::path out = fs::weakly_canonical(path_of(options.out));
  std::vector<Job> jobs;
  const OutOfMemoryGuard guard;  // the iterator of libstdc++ allocates in a noexcept function
  try {
    for (auto entry = fs::recursive_directory_iterator(path_of(options.folder));
         entry != fs::recursive_directory_iterator(); ++entry) {
      if (entry->is_directory() && fs::weakly_canonical(entry->path()) == out) {
        entry.disable_recursion_pending();  // its files are outputs
      }
      if (!entry->is_regular_file() || !is_recording(name_of(entry->path()))) {
        continue;
      }
      Job job;
      job.input = name_of(entry->path());
      // The name of a link, not of its target, so that outputs are in the folder as well.
      job.name = name_of(entry->path().lexically_relative(path_of(options.folder)));
      for (const std::string& ending : wanted) {
        job.outputs.push_back(name_of(path_of(options.out) / path_of(job.name + ending)));
      }
      jobs.push_back(job);
    }
  } catch (const fs::filesystem_error& error) {
    throw Failure(kExitNoInput, options.folder + ": " + error.code().message());
  }
  if (jobs.empty()) {
    throw Failure(kExitNoInput, options.folder + ": no video and no audio in this folder");
  }
  std::sort(jobs.begin(), jobs.end(), [](const Job& a, const Job& b) { return a.name < b.name; });
  return jobs;
}

// A progress line that several threads update.
class SharedProgress {
 public:
  SharedProgress(bool quiet, std::size_t files)
      : progress_(quiet, static_cast<std::int64_t>(files), "files") {}

  void frame_done() { show(0, 1); }
  void file_done() { show(1, 0); }

 private:
  void show(std::int64_t files, std::int64_t frames) {
    const std::scoped_lock lock(mutex_);
    files_ += files;
    frames_ += frames;
    progress_.update(files_, frames_);
  }

  std::mutex mutex_;
  Progress progress_;
  std::int64_t files_ = 0, frames_ = 0;
};

void run(const BatchOptions& options, Job& job, SharedProgress& progress) {
  const auto begin = std::chrono::steady_clock::now();
  try {
    TrackOptions each = options.each;
    each.input = job.input;
    each.animation.files = job.outputs;
    if (options.reports) {
      each.report = job.outputs.back();
      each.animation.files.pop_back();
    }
    each.animation.formats =
        each.animation.formats.empty() ? std::vector<std::string>{"csv"} : each.animation.formats;
    each.animation.writing.audio_file = job.input;
    each.quiet = true;
    each.after_frame = [&progress] { progress.frame_done(); };
    fs::create_directories(path_of(job.outputs.front()).parent_path());
    job.summary = track(each);
    job.outcome = Outcome::kDone;
  } catch (const std::exception& failure) {
    job.failure = failure.what();
    job.outcome = Outcome::kFailed;
  }
  job.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void run_all(const BatchOptions& options, std::vector<Job>& jobs) {
  SharedProgress progress(options.each.quiet, jobs.size());
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t i = next++; i < jobs.size(); i = next++) {
      if (!options.again && done_before(jobs[i])) {
        jobs[i].outcome = Outcome::kDoneBefore;
      } else {
        run(options, jobs[i], progress);
      }
      progress.file_done();
    }
  };
  const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
  const std::size_t wanted = options.jobs > 0 ? static_cast<std::size_t>(options.jobs) : cores;
  std::vector<std::thread> workers;  // Apple's library has no jthread
  for (std::size_t i = 0; i < std::min(wanted, jobs.size()); ++i) {
    workers.emplace_back(work);
  }
  for (std::thread& worker : workers) {
    worker.join();
  }
}

void print_table(const std::vector<Job>& jobs) {
  std::size_t widest = 4;
  for (const Job& job : jobs) {
    widest = std::max(widest, printable(job.name).size());
  }
  const int width = static_cast<int>(widest);
  std::printf("%-*s  %-11s %8s %9s %9s\n", width, "file", "", "frames", "with face", "frames/s");
  for (const Job& job : jobs) {
    std::printf("%-*s  %-11s", width, printable(job.name).c_str(), word(job.outcome));
    if (job.outcome == Outcome::kDone) {
      const auto frames = static_cast<double>(job.summary.frames);
      std::printf(" %8llu %7.0f %% %9.0f", static_cast<unsigned long long>(job.summary.frames),
                  100.0 * static_cast<double>(job.summary.face_frames) / std::max(1.0, frames),
                  frames / std::max(1e-9, job.seconds));
    }
    std::printf("\n");
  }
}

void print_json(const std::vector<Job>& jobs) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Job& job : jobs) {
    nlohmann::ordered_json row = {
        {"file", job.name}, {"outcome", word(job.outcome)}, {"outputs", job.outputs}};
    if (job.outcome == Outcome::kDone) {
      row["frames"] = job.summary.frames;
      row["frames_with_face"] = job.summary.face_frames;
      row["seconds"] = job.seconds;
      if (!job.summary.notes.empty()) {
        row["notes"] = job.summary.notes;
      }
    } else if (job.outcome == Outcome::kFailed) {
      row["failure"] = job.failure;
    }
    list.push_back(row);
  }
  std::printf("%s\n", json_text(list).c_str());
}

}  // namespace

bool is_recording(const std::string& path) {
  std::string ending = name_of(path_of(path).extension());
  std::transform(ending.begin(), ending.end(), ending.begin(), formats::to_lower);
  return std::find(kRecordings.begin(), kRecordings.end(), ending) != kRecordings.end();
}

void track_folder(const BatchOptions& options) {
  std::vector<Job> jobs = find_jobs(options);
  run_all(options, jobs);
  if (options.json) {
    print_json(jobs);
  } else if (!options.each.quiet) {
    print_table(jobs);
  }
  std::fflush(stdout);
  std::vector<std::string> failures, losses;
  for (const Job& job : jobs) {
    if (job.outcome == Outcome::kFailed) {
      failures.push_back(job.failure);
    } else if (!job.summary.lost.empty()) {
      losses.push_back(job.summary.lost);
    }
  }
  const std::string of_all = " of " + std::to_string(jobs.size()) + " files ";
  if (!failures.empty()) {
    throw Failure(kExitSomeFailed, std::to_string(failures.size()) + of_all + "failed:", failures);
  }
  if (!losses.empty()) {
    throw Failure(
        kExitDamaged,
        std::to_string(losses.size()) + of_all + "could be decoded only in part:", losses);
  }
}

}  // namespace mien::app
