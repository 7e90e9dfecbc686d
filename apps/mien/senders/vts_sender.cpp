// Speaks VTube Studio's plugin API, one step per frame.
#include "apps/mien/senders/vts_sender.h"

#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include "apps/mien/outputs/private_file.h"
#include "apps/mien/senders/websocket_client.h"
#include "apps/mien/system/config_folder.h"
#include "apps/mien/system/failure.h"
#include "apps/mien/system/paths.h"
#include "apps/protocols/vts.h"

namespace mien::app {
namespace {

using protocols::VtsAnswer;
using protocols::VtsAnswerKind;

constexpr std::uint16_t kVtsPort = 8001;
constexpr double kRetrySeconds = 1.0;
constexpr double kRefusedRetrySeconds = 30.0;  // because each attempt asks the user
constexpr double kAskAgainSeconds = 2.0;       // while VTube Studio asks for another connection
constexpr double kAnswerSeconds = 5.0;
constexpr int kMaxUnanswered = 4;  // frames; VTube Studio answers once per frame of its own

// The errors of a request after the user has withdrawn the permission.
bool is_withdrawn(std::int64_t error) { return error == 8 || error == 50; }

class VtsSender : public Sender {
 public:
  VtsSender(const Destination& destination, const std::string& host, std::uint16_t port,
            std::string token_file)
      : Sender(destination.text),
        server_(SocketAddress::of(host, port, "--send " + destination.text)),
        host_((host.find(':') == std::string::npos ? host : "[" + host + "]") + ":" +
              std::to_string(port)),
        token_file_(std::move(token_file)) {
    token_ = private_line(token_file_).value_or("");
    if (!token_.empty() && !protocols::is_vts_token(token_)) {
      throw Failure(kExitNoInput, "--send " + destination.text + ": " + token_file_ +
                                      ": not a token of VTube Studio");
    }
  }

  bool send(const Outgoing& outgoing) override {
    now_s_ = outgoing.since_start_s;
    if (!client_ && now_s_ >= retry_s_) {
      client_.emplace(server_, host_);
      begin(Phase::kConnecting);
    }
    if (client_) {
      step();
    }
    return !client_ || phase_ != Phase::kReady || inject(outgoing.frame);
  }

  [[nodiscard]] std::string state() const override {
    switch (phase_) {
      case Phase::kPermission:
        return "waiting for permission in VTube Studio";
      case Phase::kRefused:
        return "refused: " + note_;
      case Phase::kReady:
        return note_.empty() ? "connected" : "connected; " + note_;
      case Phase::kConnecting:
      case Phase::kAuthenticating:
        break;
    }
    return note_.empty() ? "connecting" : "not connected: " + note_ + "; retrying";
  }

 private:
  enum class Phase { kConnecting, kAuthenticating, kPermission, kReady, kRefused };

  void begin(Phase phase) {
    phase_ = phase;
    deadline_s_ = now_s_ + kAnswerSeconds;
  }

  void step() {
    const bool alive = client_->update();
    while (client_) {
      const std::optional<std::string> text = client_->receive();
      if (!text) {
        break;
      }
      take(*text);
    }
    if (!client_) {
      return;
    }
    if (!alive || (!client_->is_open() && !client_->reason().empty())) {
      return disconnect(client_->reason());
    }
    if (phase_ == Phase::kConnecting && client_->is_open()) {
      ask(protocols::vts_state_request(), Phase::kAuthenticating);
    } else if (phase_ == Phase::kPermission && ask_again_s_ && now_s_ >= *ask_again_s_) {
      ask_permission();
    } else if (awaits_answer() && now_s_ >= deadline_s_) {
      disconnect("no answer");
    }
  }

  [[nodiscard]] bool awaits_answer() const {
    return phase_ == Phase::kConnecting || phase_ == Phase::kAuthenticating ||
           (phase_ == Phase::kReady && unanswered_ > 0);
  }

  void disconnect(std::string reason) {  // a copy, because it may be the client's
    client_.reset();
    retry_s_ = now_s_ + (phase_ == Phase::kRefused ? kRefusedRetrySeconds : kRetrySeconds);
    if (phase_ != Phase::kRefused) {
      phase_ = Phase::kConnecting;
      note_ = std::move(reason);
    }
    unanswered_ = 0;
    custom_.reset();
    asked_ = false;
    ask_again_s_.reset();
  }

  void refuse(const std::string& reason) {
    phase_ = Phase::kRefused;
    note_ = reason;
  }

  void ask(const std::string& request, Phase phase) {
    client_->send(request);
    begin(phase);
  }

  void ask_permission() {
    asked_ = true;
    ask_again_s_.reset();
    ask(protocols::vts_token_request(), Phase::kPermission);
  }

  void authenticate() {
    ask(protocols::vts_authentication_request(token_), Phase::kAuthenticating);
  }

  void take(const std::string& text) {
    std::string fault;
    const std::optional<VtsAnswer> answer = protocols::parse_vts_answer(text, fault);
    if (!answer) {
      return disconnect(fault);
    }
    if (answer->kind == VtsAnswerKind::kState && phase_ == Phase::kAuthenticating) {
      token_.empty() ? ask_permission() : authenticate();
    } else if (answer->kind == VtsAnswerKind::kToken && phase_ == Phase::kPermission) {
      token_ = answer->token;
      keep_token();
      authenticate();
    } else if (answer->kind == VtsAnswerKind::kAuthentication && phase_ == Phase::kAuthenticating) {
      take_authentication(*answer);
    } else if (answer->kind == VtsAnswerKind::kCreation) {
      add_custom(answer->request);
    } else if (answer->kind == VtsAnswerKind::kInjection) {
      injected("");
    } else if (answer->kind == VtsAnswerKind::kError) {
      take_error(*answer);
    }
  }

  void take_authentication(const VtsAnswer& answer) {
    if (answer.authenticated) {
      begin(Phase::kReady);
      note_ = token_note_;
      for (std::size_t i = 0; i < formats::kControlCount; ++i) {
        if (!protocols::vts_custom_name(i).empty()) {
          client_->send(protocols::vts_creation_request(i));
        }
      }
    } else if (!asked_) {  // the token is old, or from another installation
      ask_permission();
    } else {
      refuse(answer.reason);
    }
  }

  void take_error(const VtsAnswer& answer) {
    if (answer.request == "token") {
      if (answer.error == protocols::kVtsErrorTokenRequestOngoing) {
        ask_again_s_ = now_s_ + kAskAgainSeconds;
      } else {
        refuse(answer.reason);
      }
    } else if (is_withdrawn(answer.error)) {
      disconnect(answer.reason);
    } else if (answer.request == "injection") {
      injected(answer.reason);
    } else if (phase_ == Phase::kReady) {
      note_ = answer.request + ": " + answer.reason;  // a custom parameter
    } else {
      refuse(answer.reason);
    }
  }

  void add_custom(const std::string& control) {
    const std::size_t index = formats::index_of(control, formats::kArkitNames);
    if (index < formats::kControlCount) {
      custom_.set(index);
    }
  }

  void injected(const std::string& error) {
    unanswered_ = unanswered_ > 0 ? unanswered_ - 1 : 0;
    deadline_s_ = now_s_ + kAnswerSeconds;
    note_ = error.empty() ? token_note_ : error;
  }

  // Frames that VTube Studio is too slow for are dropped.
  bool inject(const animation::Frame& frame) {
    const std::string request = protocols::vts_injection_request(frame, custom_);
    if (request.empty()) {
      return true;
    }
    if (unanswered_ >= kMaxUnanswered || !client_->is_idle()) {
      return false;
    }
    if (unanswered_ == 0) {
      deadline_s_ = now_s_ + kAnswerSeconds;
    }
    ++unanswered_;
    client_->send(request);
    return true;
  }

  // Tracking goes on without the file; VTube Studio then asks again at the next start.
  void keep_token() {
    try {
      write_private_line(token_file_, token_, "token");
      token_note_.clear();
    } catch (const Failure& failure) {
      token_note_ = failure.what();
    }
  }

  SocketAddress server_;
  std::string host_, token_file_, token_;
  std::optional<WebSocketClient> client_;  // absent until the next attempt
  Phase phase_ = Phase::kConnecting;
  std::string note_;        // why it is not connected, or the error of the last request
  std::string token_note_;  // why the token is not kept
  protocols::VtsControls custom_;
  bool asked_ = false;  // for permission, in this connection
  int unanswered_ = 0;  // frames
  double now_s_ = 0.0, retry_s_ = 0.0, deadline_s_ = 0.0;
  std::optional<double> ask_again_s_;
};

}  // namespace

std::unique_ptr<Sender> vts_sender(const Destination& requested) {
  Destination destination = requested;
  std::string token_file = destination.take("token", "");
  destination.require_all_taken();
  if (token_file.empty()) {
    const std::filesystem::path folder = config_folder();
    if (folder.empty()) {
      destination.fail("no folder for settings is known; add ?token=FILE");
    }
    std::error_code failed;
    std::filesystem::create_directories(folder, failed);  // a failure is that of the file
    token_file = name_of(folder / "vts-token");
  }
  return std::make_unique<VtsSender>(
      destination, destination.host.empty() ? kThisMachine : destination.host,
      destination.port == 0 ? kVtsPort : destination.port, std::move(token_file));
}

}  // namespace mien::app
