// Options of `mien live` and `mien devices`.
#include <memory>

#include "apps/mien/command_line/option_values.h"
#include "apps/mien/command_line/tracker_options.h"
#include "apps/mien/command_line/verbs.h"
#include "apps/mien/live/live.h"
#include "apps/mien/sources/devices.h"

namespace mien::app {

void add_live(CLI::App& program) {
  auto* verb = program.add_subcommand(
      "live", "Track the face in front of a camera and send it to other programs");
  auto options = std::make_shared<LiveOptions>();
  verb->add_option("--camera", options->camera,
                   "number or name of a camera, a URL (rtsp, http, udp, ...), test:FILE to play a "
                   "file in real time, or none (default: the first camera)");
  verb->add_option(
      "--mic", options->microphone,
      "name of a microphone, a URL, test:FILE, or none (default: the first microphone, or the "
      "audio of the camera's test:FILE; none if the camera is a URL)");
  verb->add_option(
          "--send", options->destinations,
          "destination, repeatable: vmc://HOST:PORT, llf://, ifm://, osf://, "
          "opentrack://, vrchat://, vts:// (VTube Studio), jsonl://, or - for JSON lines on "
          "standard output; HOST defaults to this machine (default: no destination)")
      ->expected(1)
      ->take_all();
  verb->add_flag("--mirror", options->mirror, "exchange left and right");
  verb->add_option("--av-offset-ms", options->av_offset_ms,
                   "the audio belongs to images that are this much later; negative: earlier")
      ->check(number_from(-10000.0, 10000.0));
  add_voice_strength(*verb, *options);
  add_field_of_view(*verb, *options);
  add_level_options(*verb, *options);
  verb->add_flag("--no-filter", options->unfiltered,
                 "no smoothing: the output of the decoders on each frame");
  verb->add_option("--neutral", options->neutral, "neutral calibration, written by `mien neutral`");
  verb->add_option("--profile", options->profile,
                   "calibration of a person, written by the page: neutral values, and a gain and a "
                   "dead zone per control; with --page, the file need not exist yet");
  auto* page =
      verb->add_option(
              "--page", options->page,
              "serve a page for this machine's browsers at this port, 1 to 65535 (default: a "
              "free port); its URL is printed")
          ->expected(0, 1)
          ->default_str("0")
          ->check(integer_from(0, 65535));
  verb->add_option("--page-token", options->page_token,
                   "keep the secret part of the page's URL in this file, created if it does not "
                   "exist (default: a new one for each run)")
      ->needs(page);
  verb->add_option("--tier", options->tier, "kernel tier: ref, avx2, avx512, ...");
  verb->add_option("--models", options->models, "folder of the model files");
  verb->add_option("--duration", options->duration_s, "end after this number of seconds")
      ->check(positive_number());
  verb->add_option("--stats", options->stats, "counts and times as JSON, written at the end");
  verb->add_flag("--quiet", options->quiet, "no screen, no summary");
  verb->callback([options] { live(*options); });
}

void add_devices(CLI::App& program) {
  auto* verb = program.add_subcommand("devices",
                                      "List the cameras and microphones that `mien live` can use");
  auto json = std::make_shared<bool>(false);
  verb->add_flag("--json", *json, "print JSON");
  verb->callback([json] { print_devices(*json); });
}

}  // namespace mien::app
