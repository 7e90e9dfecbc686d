// Counts every allocation of the process: calls after create must not allocate.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>
#include <vector>

#include "tests/tracker/blob_tracker.h"

namespace {

std::atomic<long> allocations{0};

void* counted(std::size_t bytes, std::size_t alignment) {
  ++allocations;
  void* memory = std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
  if (memory == nullptr) {
    std::abort();
  }
  return memory;
}

}  // namespace

void* operator new(std::size_t bytes) { return counted(bytes, alignof(std::max_align_t)); }
void* operator new[](std::size_t bytes) { return counted(bytes, alignof(std::max_align_t)); }
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return counted(bytes, static_cast<std::size_t>(alignment));
}
void* operator new(std::size_t bytes, std::align_val_t alignment, const std::nothrow_t&) noexcept {
  return counted(bytes, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

namespace mien::tests {
namespace {

struct CountingAllocator {
  int allocated = 0;
  int released = 0;
  std::size_t bytes = 0;

  mien_allocator callbacks() { return {&allocate, &release, this}; }

  static void* allocate(void* user, std::size_t bytes, std::size_t alignment) {
    auto* self = static_cast<CountingAllocator*>(user);
    ++self->allocated;
    self->bytes = bytes;
    return std::aligned_alloc(alignment, bytes);
  }
  static void release(void* user, void* memory) {
    ++static_cast<CountingAllocator*>(user)->released;
    std::free(memory);
  }
};

TEST(Allocation, CreateAllocatesOnceAndLaterCallsDoNot) {
  const AlignedBytes basenet = blob_basenet();
  const AlignedBytes hifinet = blob_hifinet();
  const AlignedBytes proposal = blob_proposal();
  const AlignedBytes audionet = blob_audionet();
  CountingAllocator allocator;
  BlobConfig config = blob_config(basenet, proposal, hifinet, audionet);
  config.allocator = allocator.callbacks();
  const Buffer disc(disc_picture(160.0f, 120.0f, 70.0f), {.format = MIEN_IMAGE_NV12});
  const Buffer nothing(Picture(97, 55), {.rotation = 90});
  const std::vector<std::int16_t> samples(3200, 1000);
  Audio audio;
  audio.format = MIEN_SAMPLES_INT16;
  audio.channels = 2;
  audio.frames = samples.size() / 2;
  audio.samples[0] = samples.data();
  {
    const long before_create = allocations;
    Tracker tracker;
    ASSERT_EQ(tracker.create(config), MIEN_OK);
    EXPECT_EQ(allocations, before_create) << "only the caller's allocator";
    EXPECT_EQ(allocator.allocated, 1);

    const long before = allocations;
    Result result;
    for (int i = 0; i < 60; ++i) {
      const mien_image& image = i % 20 < 12 ? disc.image() : nothing.image();
      audio.sample_rate = i < 40 ? 48000 : 44100;
      EXPECT_EQ(tracker.push_audio(audio, i * kFrameNs), MIEN_OK);
      (void)tracker.push_video(image, i * kFrameNs);
      (void)tracker.advance(i * kFrameNs + 1);
      (void)tracker.set_lod(i % 5);
      (void)tracker.get_result(result);
    }
    EXPECT_EQ(tracker.reset(), MIEN_OK);
    EXPECT_EQ(allocations, before);
    EXPECT_GT(result.face_frames, 0u);
    EXPECT_GT(result.proposal_runs, 2u);
    EXPECT_EQ(allocator.allocated, 1);
    EXPECT_EQ(allocator.released, 0);
  }
  EXPECT_EQ(allocator.released, 1);
}

TEST(Allocation, CreateAllocatesRequiredBytes) {
  const AlignedBytes basenet = blob_basenet();
  const AlignedBytes proposal = blob_proposal();
  CountingAllocator allocator;
  BlobConfig config = blob_config(basenet, proposal);
  config.allocator = allocator.callbacks();
  mien_status status = MIEN_ERROR_INTERNAL;
  const std::size_t bytes = required_bytes(config, status);
  ASSERT_EQ(status, MIEN_OK);
  Tracker tracker;
  ASSERT_EQ(tracker.create(config), MIEN_OK);
  EXPECT_EQ(allocator.bytes, bytes);
}

TEST(Allocation, ReportsOutOfMemory) {
  const AlignedBytes basenet = blob_basenet();
  const AlignedBytes proposal = blob_proposal();
  BlobConfig config = blob_config(basenet, proposal);
  config.allocator.allocate = [](void*, std::size_t, std::size_t) -> void* { return nullptr; };
  config.allocator.release = [](void*, void*) { FAIL() << "nothing was allocated"; };
  mien_tracker* tracker = nullptr;
  EXPECT_EQ(mien_tracker_create(&config, &tracker, nullptr), MIEN_ERROR_OUT_OF_MEMORY);
  EXPECT_EQ(tracker, nullptr);
}

}  // namespace
}  // namespace mien::tests
