// Serves HTTP with one thread per connection.
#include "apps/mien/live_page/http_server.h"

#include <chrono>
#include <exception>
#include <utility>

namespace mien::app {
namespace {

using protocols::HttpParse;
using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr std::size_t kMaxConnections = 32;
constexpr std::size_t kReadBytes = 4096;
constexpr milliseconds kPoll{100};          // interval of checks whether the server stops
constexpr milliseconds kRequestTime{5000};  // from the first to the last byte of a request
constexpr milliseconds kIdleTime{15000};    // between requests
constexpr milliseconds kSendTime{2000};

// Sends an empty response and reads what the client still sends, because closing a socket with
// unread bytes discards the response.
void reject(TcpConnection& connection, int status) {
  connection.send(protocols::http_response(status, "", "", {{"Connection", "close"}}), kSendTime);
  std::string rest;
  while (rest.size() < protocols::kHttpMaxBodyBytes &&
         connection.receive(rest, kReadBytes, kPoll) == TcpConnection::Received::kBytes) {
  }
}

}  // namespace

bool HttpClient::send(std::string_view bytes) { return connection_.send(bytes, kSendTime); }

HttpServer::~HttpServer() {
  stopping_ = true;
  if (thread_.joinable()) {
    thread_.join();
  }
}

void HttpServer::start(Handler handler) {
  handler_ = std::move(handler);
  thread_ = std::thread([this] { listen(); });
}

void HttpServer::listen() {
  while (!stopping_) {
    std::optional<TcpConnection> connection = listener_.accept(kPoll);
    join_finished();
    if (connection) {
      accept(std::move(*connection));
    }
  }
  for (Worker& worker : workers_) {
    worker.thread.join();
  }
}

void HttpServer::accept(TcpConnection connection) {
  if (workers_.size() >= kMaxConnections) {
    connection.send(protocols::http_response(503, "", "", {{"Connection", "close"}}), kPoll);
    return;
  }
  Worker& worker = workers_.emplace_back();
  try {
    worker.thread = std::thread([this, &worker, client = std::move(connection)]() mutable {
      try {
        serve(client);
      } catch (const std::exception&) {  // out of memory: this client is dropped, the others stay
      }
      worker.is_done = true;
    });
  } catch (const std::exception&) {  // no more threads
    workers_.pop_back();
  }
}

void HttpServer::join_finished() {
  workers_.remove_if([](Worker& worker) {
    const bool is_done = worker.is_done;
    if (is_done) {
      worker.thread.join();
    }
    return is_done;
  });
}

void HttpServer::serve(TcpConnection& connection) const {
  HttpClient client(connection, stopping_);
  std::string received;
  while (!stopping_) {
    protocols::HttpRequest request;
    const HttpParse parsed = read(connection, received, request);
    if (parsed == HttpParse::kIncomplete) {
      return;
    }
    if (parsed != HttpParse::kOk) {
      return reject(connection, static_cast<int>(parsed));
    }
    if (!handler_(request, client) || !request.keep_alive) {
      return;
    }
  }
}

// Reads the next request, and keeps the bytes after it in `received`. Returns kIncomplete
// without one: the client has closed or is too slow, or the server stops.
HttpParse HttpServer::read(TcpConnection& connection, std::string& received,
                           protocols::HttpRequest& request) const {
  auto end = steady_clock::now() + (received.empty() ? kIdleTime : kRequestTime);
  while (!stopping_ && steady_clock::now() < end) {
    std::size_t used_bytes = 0;
    const HttpParse parsed = protocols::parse_http_request(received, request, used_bytes);
    if (parsed != HttpParse::kIncomplete) {
      received.erase(0, used_bytes);
      return parsed;
    }
    const bool was_empty = received.empty();
    if (connection.receive(received, kReadBytes, kPoll) == TcpConnection::Received::kClosed) {
      return HttpParse::kIncomplete;
    }
    if (was_empty && !received.empty()) {
      end = steady_clock::now() + kRequestTime;
    }
  }
  return HttpParse::kIncomplete;
}

}  // namespace mien::app
