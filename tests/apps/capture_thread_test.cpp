// Tests of the capture thread with scripted devices. Also runs under ThreadSanitizer.
#include "apps/mien/live/capture_thread.h"

#include <gmock/gmock.h>

#include <functional>
#include <vector>

namespace mien::app::capture_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

struct Number {
  int value = 0;
};
std::int64_t duration_ns(const Number& /*number*/) { return 5'000'000; }

// Numbers 0, 1, 2 at intervals of 10 ms; optionally damaged afterwards.
struct File {
  bool damaged = false;
  int at = 0;

  bool next(Number& number, std::int64_t& pts_ns) {
    if (at == 3 && damaged) {
      throw Failure(kExitTruncated, "damaged");
    }
    number.value = at;
    pts_ns = at * 10'000'000;
    return at++ < 3;
  }
};

// The script of all devices of a test: the n-th opened device returns the n-th list, then waits for
// an interruption or fails.
struct World {
  struct Life {
    std::vector<int> gives;
    bool stays = false;
  };
  std::vector<Life> lives;
  std::size_t opened = 0;
};
using Lives = std::vector<World::Life>;
World world;

class Device {
 public:
  explicit Device(const std::string& name) {
    if (name == "nonsense") {
      throw Failure(kExitUsage, "nonsense");
    }
    life_ = world.opened < world.lives.size() ? world.lives[world.opened] : World::Life();
    ++world.opened;
  }

  bool next(Number& number, std::int64_t& time_ns) {
    if (given_ < life_.gives.size()) {
      number.value = life_.gives[given_++];
      time_ns = steady_now_ns();
      return true;
    }
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return interrupted_ || !life_.stays; });
    return false;
  }

  void interrupt() {
    {
      const std::lock_guard lock(mutex_);
      interrupted_ = true;
    }
    changed_.notify_all();
  }

  static std::string reason() { return "it has failed"; }

 private:
  World::Life life_;
  std::size_t given_ = 0;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool interrupted_ = false;
};

class Listener : public CaptureThread<File, Device, Number> {
 public:
  struct Taken {
    int value;
    std::int64_t time_ns, arrival_ns;
  };

  explicit Listener(std::unique_ptr<File> file, bool waits = false)
      : CaptureThread("it", std::move(file), waits) {}
  explicit Listener(Lives lives, bool waits = false) : CaptureThread("it", nullptr, waits) {
    world = {.lives = std::move(lives)};
  }
  explicit Listener(const std::string& name) : CaptureThread(name, nullptr, true) {}
  ~Listener() override { stop(); }

  // Waits up to 20 s.
  bool comes(const std::function<bool(const Listener&)>& what) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, std::chrono::seconds(20), [&] { return what(*this); });
  }
  [[nodiscard]] bool has_ended() const { return ended_; }
  [[nodiscard]] bool has_failed() const { return failure_ != nullptr; }
  [[nodiscard]] const std::vector<Taken>& taken() const { return taken_; }
  [[nodiscard]] std::vector<int> values() const {
    std::vector<int> values;
    for (const Taken& each : taken_) {
      values.push_back(each.value);
    }
    return values;
  }

 private:
  void take(const Number& number, std::int64_t time_ns, std::int64_t arrival_ns) override {
    {
      const std::lock_guard lock(mutex_);
      taken_.push_back({number.value, time_ns, arrival_ns});
    }
    changed_.notify_all();
  }

  std::vector<Taken> taken_;
};

auto took(std::size_t count) {
  return [count](const Listener& listener) { return listener.taken().size() == count; };
}

TEST(CaptureThread, AFilePlaysInRealTime) {
  Listener listener(std::make_unique<File>());
  const std::int64_t begin_ns = steady_now_ns() + 20'000'000;
  listener.start(begin_ns);
  ASSERT_TRUE(listener.comes(&Listener::has_ended));
  EXPECT_GE(steady_now_ns(), begin_ns + 25'000'000) << "the last one has arrived at the end";
  EXPECT_THAT(listener.values(), ElementsAre(0, 1, 2));
  for (const Listener::Taken& each : listener.taken()) {
    EXPECT_EQ(each.time_ns, begin_ns + each.value * 10'000'000);
    EXPECT_GE(each.arrival_ns, each.time_ns + 5'000'000);
  }
  EXPECT_FALSE(listener.has_failed());
  EXPECT_THAT(listener.error(), IsEmpty());
}

TEST(CaptureThread, ADamagedFileEndsWithAFailure) {
  Listener listener(std::make_unique<File>(File{.damaged = true}));
  listener.start(steady_now_ns());
  ASSERT_TRUE(listener.comes(&Listener::has_ended));
  EXPECT_THAT(listener.values(), ElementsAre(0, 1, 2));
  EXPECT_TRUE(listener.has_failed());
  EXPECT_EQ(listener.error(), "damaged");
}

TEST(CaptureThread, ADeviceThatFailsIsReopened) {
  Listener listener(Lives{{.gives = {7}}, {}, {.gives = {8}, .stays = true}});
  listener.start(0);
  ASSERT_TRUE(listener.comes(took(1)));
  ASSERT_TRUE(listener.comes(took(2)));
  EXPECT_THAT(listener.values(), ElementsAre(7, 8));
  EXPECT_FALSE(listener.has_failed()) << "the device has worked";
  EXPECT_THAT(listener.error(), IsEmpty());
}

TEST(CaptureThread, AMissingDeviceFailsOrIsRetried) {
  {
    Listener needed(Lives{});
    needed.start(0);
    ASSERT_TRUE(needed.comes(&Listener::has_failed));
    EXPECT_EQ(needed.error(), "it: it has failed");
  }
  Listener waiting(Lives{{}, {.gives = {1}, .stays = true}}, true);
  waiting.start(0);
  ASSERT_TRUE(waiting.comes(took(1)));
  EXPECT_FALSE(waiting.has_failed());
}

TEST(CaptureThread, AnInvalidNameFailsAtOnce) {
  Listener listener("nonsense");
  EXPECT_THROW(listener.start(0), Failure);
}

TEST(CaptureThread, ASilentDeviceIsReopenedWithTheReason) {
  Listener listener(Lives{{.gives = {1}, .stays = true}, {.gives = {2}, .stays = true}});
  listener.start(0);
  ASSERT_TRUE(listener.comes(took(1)));
  listener.restart("it is silent");
  while (listener.error().empty()) {
    std::this_thread::yield();
  }
  EXPECT_EQ(listener.error(), "it: it is silent");
  ASSERT_TRUE(listener.comes(took(2)));
  EXPECT_THAT(listener.error(), IsEmpty());
}

TEST(CaptureThread, StopsDuringEveryWait) {
  const auto far_ns = steady_now_ns() + 3'600'000'000'000;
  { Listener(std::make_unique<File>()).start(far_ns); }
  { Listener(Lives{{.gives = {}, .stays = true}}, true).start(0); }
  Listener gone(Lives{{.gives = {1}}});
  gone.start(0);
  ASSERT_TRUE(gone.comes(took(1)));  // and stops while it waits to retry
  EXPECT_THAT(gone.values(), SizeIs(1));
}

}  // namespace
}  // namespace mien::app::capture_test
