// Answers the requests of the page.
#include "apps/mien/live_page/page_server.h"

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>

#include "apps/mien/live/inputs.h"
#include "apps/mien/pages/page_sources.h"
#include "apps/mien/pages/page_text.h"
#include "apps/mien/sources/devices.h"
#include "apps/mien/system/failure.h"
#include "apps/mien/system/json_text.h"

namespace mien::app {
namespace {

using protocols::HttpRequest;
using std::chrono::milliseconds;

constexpr milliseconds kPreviewTime{300};
constexpr milliseconds kEventTime{100};
constexpr int kKeepAliveRounds = 50;  // of kEventTime
constexpr std::string_view kJson = "application/json";
constexpr std::string_view kText = "text/plain; charset=utf-8";

// Takes the same time wherever the texts differ.
bool begins_with_secret(std::string_view text, std::string_view secret) {
  unsigned difference = text.size() < secret.size() ? 1 : 0;
  for (std::size_t i = 0; i < std::min(text.size(), secret.size()); ++i) {
    difference |= static_cast<unsigned char>(text[i]) ^ static_cast<unsigned char>(secret[i]);
  }
  return difference == 0;
}

bool respond(HttpClient& client, int status, std::string_view type = "",
             std::string_view body = "") {
  return client.send(protocols::http_response(status, type, body,
                                              {{"Cache-Control", "no-store"},
                                               {"Referrer-Policy", "no-referrer"},
                                               {"X-Content-Type-Options", "nosniff"},
                                               {"X-Frame-Options", "DENY"},
                                               {"Cross-Origin-Resource-Policy", "same-origin"}}));
}

bool send_devices(HttpClient& client) {
  nlohmann::ordered_json list = {{"cameras", nlohmann::ordered_json::array()},
                                 {"microphones", nlohmann::ordered_json::array()}};
  try {
    for (const Device& device : devices()) {
      list[device.kind == CaptureKind::kCamera ? "cameras" : "microphones"].push_back(
          {{"name", device.name}, {"description", device.description}});
    }
  } catch (const Failure& failure) {
    list["problem"] = failure.what();
  }
  return respond(client, 200, kJson, json_text(list, -1));
}

bool is_listed(CaptureKind kind, const std::string& name) {
  try {
    const std::vector<Device> all = devices();
    return std::any_of(all.begin(), all.end(), [&](const Device& device) {
      return device.kind == kind && device.name == name;
    });
  } catch (const Failure&) {  // no ffmpeg, so no device can be opened
    return false;
  }
}

std::string event(std::string_view name, std::string_view data) {
  return data.empty()
             ? std::string()
             : std::string("event: ").append(name).append("\ndata: ").append(data).append("\n\n");
}

}  // namespace

PageServer::PageServer(std::uint16_t port, const std::string& token, Board& board,
                       std::vector<std::string> devices)
    : board_(board),
      devices_(std::move(devices)),
      page_(filled(kLivePage, {{"@AVATAR@", kAvatarScript}})),
      obs_page_(filled(kObsPage, {{"@AVATAR@", kAvatarScript}})),
      secret_path_("/" + token + "/"),
      server_(port, "--page") {
  devices_.emplace_back(LiveInputs::kNoInput);
  const std::string digits = std::to_string(server_.port());
  host_ = "127.0.0.1:" + digits;
  local_host_ = "localhost:" + digits;
  url_ = "http://" + host_ + secret_path_;
  server_.start(
      [this](const HttpRequest& request, HttpClient& client) { return answer(request, client); });
}

bool PageServer::is_allowed(const HttpRequest& request) const {
  const std::string_view host = request.field("host"), origin = request.field("origin");
  const bool is_host = host == host_ || host == local_host_;
  const bool is_origin =
      origin.empty() || origin == "http://" + host_ || origin == "http://" + local_host_;
  return is_host && is_origin && begins_with_secret(request.target, secret_path_);
}

bool PageServer::answer(const HttpRequest& request, HttpClient& client) {
  if (!is_allowed(request)) {
    return client.send(protocols::http_response(403, "", ""));
  }
  const std::string_view page = std::string_view(request.target).substr(secret_path_.size());
  if (request.method == "GET") {
    return get(page, client);
  }
  return request.method == "POST" ? post(page, request, client) : respond(client, 405);
}

bool PageServer::get(std::string_view page, HttpClient& client) {
  constexpr std::string_view kHtml = "text/html; charset=utf-8";
  if (page.empty()) {
    return respond(client, 200, kHtml, page_);
  }
  if (page == "obs") {
    return respond(client, 200, kHtml, obs_page_);
  }
  if (page == "events") {
    return stream_events(client);
  }
  if (page == "preview") {
    return send_preview(client);
  }
  if (page == "profile") {
    return send_profile(client);
  }
  return page == "devices" ? send_devices(client) : respond(client, 404);
}

// A body of another type than JSON could come from a form of any web site.
bool PageServer::post(std::string_view page, const HttpRequest& request, HttpClient& client) {
  if (page != "command") {
    return respond(client, 404);
  }
  if (request.field("content-type") != kJson) {
    return respond(client, 415);
  }
  std::string fault;
  std::optional<PageCommand> command = parse_command(request.body, fault);
  if (!command) {
    return respond(client, 400, kText, fault);
  }
  if (!may_open(*command)) {
    return respond(client, 400, kText, "name: not a device of this machine");
  }
  return respond(client, board_.add_command(std::move(*command)) ? 204 : 503);
}

// Server-sent events until the client leaves. Returns false, because the response has no length.
bool PageServer::stream_events(HttpClient& client) {
  std::string head = protocols::http_head(200, {{"Content-Type", "text/event-stream"},
                                                {"Cache-Control", "no-store"},
                                                {"Connection", "close"}});
  bool is_open = client.send(head + "\r\n");
  Board::News news;
  int silent_rounds = 0;
  while (is_open && !client.stopping()) {
    if (board_.wait(news, kEventTime)) {
      is_open = client.send(event("state", news.state) + event("frame", news.frame));
      silent_rounds = 0;
    } else if (++silent_rounds % kKeepAliveRounds == 0) {
      is_open = client.send(":\n\n");  // a comment, which fails if the client has left
    }
  }
  return false;
}

bool PageServer::may_open(const PageCommand& command) const {
  const auto* camera = std::get_if<SetCamera>(&command);
  const auto* microphone = std::get_if<SetMicrophone>(&command);
  if (camera == nullptr && microphone == nullptr) {
    return true;
  }
  const std::string& name = camera != nullptr ? camera->name : microphone->name;
  return std::find(devices_.begin(), devices_.end(), name) != devices_.end() ||
         is_listed(camera != nullptr ? CaptureKind::kCamera : CaptureKind::kMicrophone, name);
}

bool PageServer::send_profile(HttpClient& client) {
  const std::string profile = board_.profile();
  return profile.empty() ? respond(client, 404) : respond(client, 200, kJson, profile);
}

bool PageServer::send_preview(HttpClient& client) {
  const std::string image = board_.preview(kPreviewTime);
  return image.empty() ? respond(client, 204) : respond(client, 200, "image/bmp", image);
}

}  // namespace mien::app
