// Tests of the parts of `mien live`.
#include <gmock/gmock.h>
#include <unistd.h>

#include <cmath>

#include "apps/animation/mirror.h"
#include "apps/mien/live/easing.h"
#include "apps/mien/senders/destination.h"
#include "apps/mien/sources/device_lists.h"
#include "apps/mien/sources/sample_clock.h"
#include "apps/mien/system/failure.h"
#include "apps/mien/system/socket_calls.h"
#include "apps/mien/system/udp_socket.h"

namespace mien::app {
namespace {

using animation::FaceState;
using animation::Frame;
using formats::control;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(Destination, ParsesUrls) {
  Destination destination = parse_destination("vmc://[::1]:39540/?names=camel&x=a%20b");
  EXPECT_EQ(destination.scheme, "vmc");
  EXPECT_EQ(destination.host, "::1");
  EXPECT_EQ(destination.port, 39540);
  EXPECT_EQ(destination.take("x", ""), "a b");
  EXPECT_THROW(destination.require_all_taken(), Failure);
  EXPECT_EQ(destination.take("names", "vrm0"), "camel");
  EXPECT_EQ(destination.take("names", "vrm0"), "vrm0");
  EXPECT_NO_THROW(destination.require_all_taken());
}

TEST(Destination, NamesTheError) {
  for (const auto& [text, wanted] : {std::pair{"127.0.0.1:1", "expected a URL such as"},
                                     {"vmc://h:0", "invalid port (got '0'"},
                                     {"vmc://h:", "invalid port (got ''"},
                                     {"vmc://h:12a", "invalid port (got '12a'"},
                                     {"vmc://h:65536", "invalid port"},
                                     {"vmc://a:b:1", "IPv6"},
                                     {"vmc://[::1", "'['"},
                                     {"vmc://[::1]1", "'['"},
                                     {"vmc://h?names", "expected NAME=VALUE"},
                                     {"vmc://h?a=1&a=2", "duplicate option 'a'"},
                                     {"vmc://h?a=%4", "hexadecimal"},
                                     {"vmc://h?a=%00", "hexadecimal"},
                                     {"vmc://h?=1", "expected NAME=VALUE"}}) {
    try {
      static_cast<void>(parse_destination(text));
      FAIL() << text;
    } catch (const Failure& failure) {
      EXPECT_EQ(failure.code(), kExitUsage);
      EXPECT_THAT(failure.what(), HasSubstr(wanted)) << text;
      EXPECT_THAT(failure.what(), HasSubstr(text));
    }
  }
}

addrinfo address_of(int family, addrinfo* next) {
  addrinfo address = {};
  address.ai_family = family;
  address.ai_next = next;
  return address;
}

// Many receivers listen on 127.0.0.1 only, but many systems resolve "localhost" to ::1 first.
TEST(UdpSocket, PrefersAnAddressOfIpv4) {
  addrinfo second_v4 = address_of(AF_INET, nullptr), first_v4 = address_of(AF_INET, &second_v4);
  addrinfo last_v6 = address_of(AF_INET6, nullptr), next_v6 = address_of(AF_INET6, &last_v6);
  const addrinfo mixed = address_of(AF_INET6, &first_v4), v6 = address_of(AF_INET6, &next_v6);
  EXPECT_EQ(&sockets::preferred(mixed), &first_v4);
  EXPECT_EQ(&sockets::preferred(first_v4), &first_v4);
  EXPECT_EQ(&sockets::preferred(v6), &v6);
}

TEST(UdpSocket, ReachesThisMachineByItsName) {
  const int receiver = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t bytes = sizeof address;
  ASSERT_EQ(bind(receiver, reinterpret_cast<sockaddr*>(&address), bytes), 0);
  ASSERT_EQ(getsockname(receiver, reinterpret_cast<sockaddr*>(&address), &bytes), 0);
  EXPECT_TRUE(UdpSocket::to("localhost", ntohs(address.sin_port), "test").send("a face"));
  char got[16] = {};
  EXPECT_EQ(recv(receiver, got, sizeof got, MSG_DONTWAIT), 6);
  close(receiver);
}

constexpr std::int64_t kMs = 1'000'000;

TEST(SampleClock, EstimatesRecordingTimesOfLateSamples) {
  SampleClock clock(16000);
  std::int64_t worst = 0;
  for (int block = 0; block < 1000; ++block) {  // of 10 ms; some are up to 30 ms late
    const std::int64_t recorded = block * 10 * kMs;
    const std::int64_t late = (block * 7 % 4) * 10 * kMs;
    const std::int64_t estimated = clock.time_of(160, recorded + 10 * kMs + late);
    worst = block > 10 ? std::max(worst, std::abs(estimated - recorded)) : 0;
  }
  EXPECT_LT(worst, 2 * kMs);
}

TEST(SampleClock, FollowsAnotherClock) {
  SampleClock clock(16000);
  for (int block = 0; block < 60000; ++block) {  // ten minutes of a sound card that is 0.01 % slow
    const auto recorded = static_cast<std::int64_t>(block * 10.001 * kMs);
    const std::int64_t estimated = clock.time_of(160, recorded + 10 * kMs);
    ASSERT_LT(std::abs(estimated - recorded), 5 * kMs) << block;
  }
}

TEST(SampleClock, RestartsAfterAGap) {
  SampleClock clock(16000);
  EXPECT_EQ(clock.time_of(160, 10 * kMs), 0);
  EXPECT_EQ(clock.time_of(160, 20 * kMs), 10 * kMs);
  EXPECT_EQ(clock.time_of(160, 1000 * kMs), 990 * kMs);
}

Frame frame(std::int64_t ms, FaceState state, double jaw, double yaw) {
  Frame made;
  made.time_ns = ms * kMs;
  made.state = state;
  made.controls[control("jawOpen")] = jaw;
  if (state == FaceState::kTracking) {
    made.head = animation::Angles{0.0, yaw, 0.0};
    made.position_m = {0.1, 0.0, -0.6};
  }
  return made;
}

TEST(Easing, DoesNotChangeATrackedFace) {
  Easing easing;
  for (int i = 0; i < 30; ++i) {
    const Frame shown = easing.next(frame(i * 33, FaceState::kTracking, 0.1 * (i % 10), 0.3));
    EXPECT_EQ(shown.controls[control("jawOpen")], 0.1 * (i % 10));
    EXPECT_EQ(shown.head->yaw, 0.3);
  }
}

TEST(Easing, HoldsThenEasesWithoutJumps) {
  Easing easing;
  static_cast<void>(easing.next(frame(0, FaceState::kTracking, 0.8, 0.5)));
  double jaw = 0.8, yaw = 0.5;
  for (int ms = 10; ms <= 2000; ms += 10) {
    const Frame shown = easing.next(frame(ms, FaceState::kLost, 0.8 * std::exp(-ms / 250.0), 0));
    const double now = shown.controls[control("jawOpen")];
    if (ms <= 500) {
      EXPECT_EQ(now, 0.8) << ms;
      EXPECT_EQ(shown.head->yaw, 0.5) << ms;
    }
    EXPECT_LE(std::abs(now - jaw), 0.02) << ms;
    EXPECT_LE(std::abs(shown.head->yaw - yaw), 0.02) << ms;
    EXPECT_THAT(*shown.position_m, ElementsAre(0.1, 0.0, -0.6));
    jaw = now;
    yaw = shown.head->yaw;
  }
  EXPECT_LT(jaw, 0.001);
  EXPECT_EQ(yaw, 0.0);
  for (int ms = 2010; ms <= 2500; ms += 10) {
    const Frame shown = easing.next(frame(ms, FaceState::kTracking, 0.6, -0.4));
    EXPECT_LE(std::abs(shown.controls[control("jawOpen")] - jaw), 0.1) << ms;
    jaw = shown.controls[control("jawOpen")];
    yaw = shown.head->yaw;
  }
  EXPECT_EQ(jaw, 0.6);
  EXPECT_EQ(yaw, -0.4);
}

TEST(Easing, HasNoHeadBeforeTheFirstFace) {
  Easing easing;
  EXPECT_FALSE(easing.next(frame(0, FaceState::kSearching, 0.0, 0.0)).head.has_value());
}

TEST(Mirror, TwiceIsTheIdentity) {
  Frame face = frame(0, FaceState::kTracking, 0.5, 0.25);
  face.controls[control("mouthLeft")] = 0.75;
  face.controls[control("eyeBlinkRight")] = 1.0;
  face.eyes = {animation::Angles{0.1, 0.2, 0.0}, animation::Angles{0.3, 0.4, 0.0}};
  const Frame mirror = animation::mirrored(face);
  EXPECT_EQ(mirror.controls[control("mouthRight")], 0.75);
  EXPECT_EQ(mirror.controls[control("eyeBlinkLeft")], 1.0);
  EXPECT_EQ(mirror.controls[control("jawOpen")], 0.5);
  EXPECT_EQ(mirror.head->yaw, -0.25);
  EXPECT_EQ((*mirror.position_m)[0], -0.1);
  EXPECT_EQ((*mirror.eyes)[0].yaw, -0.4);
  const Frame again = animation::mirrored(mirror);
  EXPECT_EQ(again.controls[control("mouthLeft")], 0.75);
  EXPECT_EQ(again.head->yaw, 0.25);
  EXPECT_EQ((*again.eyes)[1].yaw, 0.4);
}

auto device(CaptureKind kind, const std::string& name, const std::string& description) {
  return testing::AllOf(testing::Field(&Device::kind, kind), testing::Field(&Device::name, name),
                        testing::Field(&Device::description, description));
}

TEST(DeviceLists, AreParsedForEverySystem) {
  using enum CaptureKind;
  EXPECT_THAT(parse_avfoundation(
                  "[AVFoundation indev @ 0x7f] AVFoundation video devices:\n"
                  "[AVFoundation indev @ 0x7f] [0] FaceTime HD Camera\n"
                  "[AVFoundation indev @ 0x7f] AVFoundation audio devices:\n"
                  "[AVFoundation indev @ 0x7f] [0] MacBook Microphone\n: Input/output error"),
              ElementsAre(device(kCamera, "0", "FaceTime HD Camera"),
                          device(kMicrophone, "0", "MacBook Microphone")));
  EXPECT_THAT(parse_dshow("[dshow @ 01] \"Integrated Camera\" (video)\r\n"
                          "[dshow @ 01]   Alternative name \"@device_pnp\"\r\n"
                          "[dshow @ 01] \"Microphone (Realtek)\" (audio)\r\n"),
              ElementsAre(device(kCamera, "Integrated Camera", "Integrated Camera"),
                          device(kMicrophone, "Microphone (Realtek)", "Microphone (Realtek)")));
  EXPECT_THAT(parse_dshow("[dshow @ 01] DirectShow video devices (some may be both)\n"
                          "[dshow @ 01]  \"Webcam\"\n[dshow @ 01] DirectShow audio devices\n"
                          "[dshow @ 01]  \"Mic\"\n"),
              ElementsAre(device(kCamera, "Webcam", "Webcam"), device(kMicrophone, "Mic", "Mic")));
  EXPECT_THAT(parse_pulse("Auto-detected sources for pulse:\n"
                          "  alsa_output.pci.monitor [Monitor of Built-in] (audio)\n"
                          "* alsa_input.usb [USB [stereo] Mic] (audio)\n"),
              ElementsAre(device(kMicrophone, "alsa_input.usb", "USB [stereo] Mic")));
  EXPECT_THAT(parse_alsa("00-00: ALC257 : ALC257 : playback 1 : capture 1\n"
                         "00-03: HDMI 0 : HDMI 0 : playback 1\n01-00: x\nzz"),
              ElementsAre(device(kMicrophone, "alsa:hw:0,0", "ALC257")));
  EXPECT_THAT(parse_dshow("\"\n\"\" (video\n[\n] \""), ElementsAre());
}

}  // namespace
}  // namespace mien::app
