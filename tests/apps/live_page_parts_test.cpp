// Tests of the parts of `mien live --page` that need no program.
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "apps/mien/live/advice.h"
#include "apps/mien/live/profile.h"
#include "apps/mien/live_page/board.h"
#include "apps/mien/live_page/preview.h"
#include "apps/mien/system/failure.h"
#include "apps/mien/system/tcp_socket.h"
#include "apps/protocols/http.h"

namespace mien::app {
namespace {

using protocols::HttpParse;
using protocols::HttpRequest;
using std::chrono::milliseconds;

constexpr milliseconds kAtOnce{0};

HttpParse parsed(const std::string& text) {
  HttpRequest request;
  std::size_t used_bytes = 0;
  return protocols::parse_http_request(text, request, used_bytes);
}

TEST(Http, ReadsARequestAndLeavesTheNext) {
  const std::string first =
      "POST /a?b HTTP/1.1\r\nHOST: x\r\nContent-Length: 3\r\nX-Y:  z \t\r\n\r\nabc";
  HttpRequest request;
  std::size_t used_bytes = 0;
  ASSERT_EQ(protocols::parse_http_request(first + "GET", request, used_bytes), HttpParse::kOk);
  EXPECT_EQ(used_bytes, first.size());
  EXPECT_EQ(request.method, "POST");
  EXPECT_EQ(request.target, "/a?b");
  EXPECT_EQ(request.body, "abc");
  EXPECT_EQ(request.field("host"), "x");
  EXPECT_EQ(request.field("x-y"), "z");
  EXPECT_EQ(request.field("absent"), "");
  EXPECT_TRUE(request.keep_alive);
}

TEST(Http, IsIncompleteUntilTheLastByte) {
  const std::string whole = "POST / HTTP/1.1\r\nHost: x\r\nContent-Length: 3\r\n\r\nabc";
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_EQ(parsed(whole.substr(0, size)), HttpParse::kIncomplete) << size;
  }
  EXPECT_EQ(parsed(whole), HttpParse::kOk);
}

TEST(Http, LimitsHeadAndBody) {
  const std::string begin = "GET / HTTP/1.1\r\nHost: x\r\nA: ";
  const std::size_t room = protocols::kHttpMaxHeadBytes - begin.size() - 4;
  EXPECT_EQ(parsed(begin + std::string(room, 'a') + "\r\n\r\n"), HttpParse::kOk);
  EXPECT_EQ(parsed(begin + std::string(room + 1, 'a') + "\r\n\r\n"), HttpParse::kHeadTooLarge);
  EXPECT_EQ(parsed(std::string(protocols::kHttpMaxHeadBytes, 'a')), HttpParse::kHeadTooLarge);
  const std::string post = "POST / HTTP/1.1\r\nHost: x\r\nContent-Length: ";
  EXPECT_EQ(parsed(post + "16384\r\n\r\n"), HttpParse::kIncomplete);
  EXPECT_EQ(parsed(post + "16385\r\n\r\n"), HttpParse::kBodyTooLarge);
}

TEST(Http, RejectsAmbiguousRequests) {
  const std::string host = "Host: x\r\n";
  EXPECT_EQ(parsed("GET / HTTP/1.1\r\n\r\n"), HttpParse::kMalformed);
  EXPECT_EQ(parsed("GET / HTTP/1.1\r\n" + host + host + "\r\n"), HttpParse::kMalformed);
  EXPECT_EQ(parsed("GET / HTTP/1.1\r\n" + host + "A : b\r\n\r\n"), HttpParse::kMalformed);
  EXPECT_EQ(parsed("GET / HTTP/1.1\r\n" + host + " A: b\r\n\r\n"), HttpParse::kMalformed);
  EXPECT_EQ(parsed("GET / HTTP/1.1\r\n" + host + "A: b\nC: d\r\n\r\n"), HttpParse::kMalformed);
  EXPECT_EQ(parsed("GET  / HTTP/1.1\r\n" + host + "\r\n"), HttpParse::kMalformed);
  EXPECT_EQ(parsed("GET x HTTP/1.1\r\n" + host + "\r\n"), HttpParse::kMalformed);
  EXPECT_EQ(parsed("GET / HTTP/3\r\n" + host + "\r\n"), HttpParse::kVersion);
  EXPECT_EQ(parsed("POST / HTTP/1.1\r\n" + host + "Content-Length: 1, 1\r\n\r\nx"),
            HttpParse::kMalformed);
  EXPECT_EQ(parsed("POST / HTTP/1.1\r\n" + host + "Transfer-Encoding: identity\r\n\r\n"),
            HttpParse::kUnsupported);
}

TEST(Http, ClosesWhenAskedAndWithOldClients) {
  HttpRequest request;
  std::size_t used_bytes = 0;
  for (const char* text : {"GET / HTTP/1.0\r\nHost: x\r\n\r\n",
                           "GET / HTTP/1.1\r\nHost: x\r\nConnection: Close\r\n\r\n"}) {
    ASSERT_EQ(protocols::parse_http_request(text, request, used_bytes), HttpParse::kOk);
    EXPECT_FALSE(request.keep_alive) << text;
  }
}

TEST(Http, WritesResponses) {
  EXPECT_EQ(
      protocols::http_response(404, "text/plain", "no", {{"A", "b"}}),
      "HTTP/1.1 404 Not Found\r\nA: b\r\nContent-Type: text/plain\r\nContent-Length: 2\r\n\r\nno");
  EXPECT_EQ(protocols::http_response(204, "", ""), "HTTP/1.1 204 No Content\r\n\r\n");
}

TEST(Profile, AdjustsWithinTheRange) {
  EXPECT_DOUBLE_EQ(adjusted(0.5, {}), 0.5);
  EXPECT_DOUBLE_EQ(adjusted(0.1, {2.0, 0.1}), 0.0);
  EXPECT_DOUBLE_EQ(adjusted(0.55, {1.0, 0.1}), 0.5);
  EXPECT_DOUBLE_EQ(adjusted(0.55, {3.0, 0.1}), 1.0);
  EXPECT_DOUBLE_EQ(adjusted(1.0, {1.0, 0.9}), 1.0);
  EXPECT_FALSE(formats::driven(adjusted(formats::kNoNumber, {2.0, 0.1})));
}

TEST(Profile, SurvivesItsFile) {
  Profile profile;
  profile.controls[17] = {1.5, 0.25};
  profile.neutral = std::string(MIEN_NEUTRAL_BYTES, '\x7f');
  std::string fault;
  const std::optional<Profile> read = parse_profile(profile_text(profile), fault);
  ASSERT_TRUE(read) << fault;
  EXPECT_EQ(read->neutral, profile.neutral);
  EXPECT_EQ(read->controls[17].gain, 1.5);
  EXPECT_EQ(read->controls[17].dead_zone, 0.25);
  EXPECT_EQ(read->controls[0].gain, 1.0);
}

TEST(Board, KeepsTheLatestOnly) {
  Board board;
  Board::News news;
  EXPECT_FALSE(board.wait(news, kAtOnce));
  board.put_frame("1");
  board.put_frame("2");
  board.put_state("s");
  ASSERT_TRUE(board.wait(news, kAtOnce));
  EXPECT_EQ(news.frame, "2");
  EXPECT_EQ(news.state, "s");
  board.put_state("s");  // unchanged
  EXPECT_FALSE(board.wait(news, kAtOnce));
  board.put_frame("3");
  ASSERT_TRUE(board.wait(news, kAtOnce));
  EXPECT_EQ(news.frame, "3");
  EXPECT_EQ(news.state, "");
}

TEST(Board, HoldsALimitedNumberOfCommands) {
  Board board;
  int accepted = 0;
  while (board.add_command(SaveProfile{})) {
    ++accepted;
  }
  EXPECT_EQ(accepted, 64);
  ASSERT_TRUE(board.next_command());
  EXPECT_TRUE(board.add_command(CaptureNeutral{}));
}

TEST(Board, WantsAPreviewOnlyWhileAReaderWaits) {
  Board board;
  EXPECT_FALSE(board.preview_wanted());
  EXPECT_EQ(board.preview(kAtOnce), "");
  std::string image;
  std::thread reader([&] { image = board.preview(milliseconds(10'000)); });
  while (!board.preview_wanted()) {
    std::this_thread::yield();
  }
  board.put_preview("image");
  reader.join();
  EXPECT_EQ(image, "image");
  EXPECT_FALSE(board.preview_wanted());
}

// Blue, green and red of a pixel from the top left.
std::array<int, 3> pixel_of(const std::string& bmp, int x, int y, int height) {
  const std::size_t row_bytes = (bmp.size() - 54) / static_cast<std::size_t>(height);
  const std::size_t at =
      54 + static_cast<std::size_t>(height - 1 - y) * row_bytes + static_cast<std::size_t>(x) * 3;
  return {static_cast<unsigned char>(bmp[at]), static_cast<unsigned char>(bmp[at + 1]),
          static_cast<unsigned char>(bmp[at + 2])};
}

TEST(Preview, KeepsTheColorsOfSmallImages) {
  const std::array<unsigned char, 18> pixels = {255, 0, 0, 0, 255, 0, 0, 0, 255,
                                                1,   2, 3, 4, 5,   6, 7, 8, 9};
  mien_image image;
  mien_image_default(&image);
  image.format = MIEN_IMAGE_RGB;
  image.width = 3;
  image.height = 2;
  image.planes[0] = pixels.data();
  image.row_stride_bytes[0] = 9;
  const std::string bmp = preview_of(image);
  EXPECT_EQ(bmp.size(), 54U + 2 * 12);
  EXPECT_EQ(pixel_of(bmp, 0, 0, 2), (std::array{0, 0, 255}));
  EXPECT_EQ(pixel_of(bmp, 2, 0, 2), (std::array{255, 0, 0}));
  EXPECT_EQ(pixel_of(bmp, 2, 1, 2), (std::array{9, 8, 7}));
}

TEST(Preview, ConvertsYuvOfBothRanges) {
  const std::vector<unsigned char> luma(std::size_t{640} * 480, 81),
      blue(std::size_t{320} * 240, 90), red(std::size_t{320} * 240, 240);
  mien_image image;
  mien_image_default(&image);
  image.format = MIEN_IMAGE_I420;
  image.width = 640;
  image.height = 480;
  image.full_range = 0;
  image.planes[0] = luma.data();
  image.planes[1] = blue.data();
  image.planes[2] = red.data();
  image.row_stride_bytes[0] = 640;
  image.row_stride_bytes[1] = image.row_stride_bytes[2] = 320;
  const std::array<int, 3> color = pixel_of(preview_of(image), 319, 239, 240);
  EXPECT_NEAR(color[0], 0, 2);  // 81, 90, 240 is pure red
  EXPECT_NEAR(color[1], 0, 2);
  EXPECT_NEAR(color[2], 255, 2);
  image.full_range = 1;
  EXPECT_NEAR(pixel_of(preview_of(image), 0, 0, 240)[2], 81 + 1.402 * 112, 2);
}

TEST(Preview, HasSquarePixels) {
  const std::vector<unsigned char> gray(std::size_t{720} * 576, 128);
  mien_image image;
  mien_image_default(&image);
  image.format = MIEN_IMAGE_GRAY8;
  image.width = 720;
  image.height = 576;
  image.pixel_aspect = 16.0f / 15.0f;
  image.planes[0] = gray.data();
  image.row_stride_bytes[0] = 720;
  EXPECT_EQ(preview_of(image).size(), 54U + 320 * 240 * 3);
}

TEST(Advice, SaysWhatToDo) {
  EXPECT_EQ(advised(CaptureKind::kCamera, "/dev/video0: Permission denied"),
            "/dev/video0: Permission denied; allow the camera: on Linux, add the user to the group "
            "video");
  EXPECT_EQ(advised(CaptureKind::kMicrophone, "x"), "x");
  EXPECT_EQ(advised(CaptureKind::kCamera, "cannot run 'ffmpeg': Permission denied; install it"),
            "cannot run 'ffmpeg': Permission denied; install it");
}

TEST(TcpListener, AnOccupiedPortIsAFailure) {
  const TcpListener first(0, "first");
  EXPECT_NE(first.port(), 0);
  EXPECT_THROW(TcpListener(first.port(), "second"), Failure);
}

}  // namespace
}  // namespace mien::app
