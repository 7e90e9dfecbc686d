#!/usr/bin/env python3
"""AudioNet's training: the same features as audio/, streaming as the whole, exact folding, alignment and curves that
make sense."""
import tempfile
import unittest
from pathlib import Path

import numpy as np
import torch

from mien_convert.atomic_files import write_whole
from mien_training.audio import (
    activity,
    add_jaw,
    align,
    audio_net,
    effects,
    export,
    features,
    golden_outputs,
    jaw,
    labels,
    opus,
    phonemes,
    recognition,
    visemes,
    warm_start,
)
from mien_training.audio.audio_net import SPEECH_CONTROLS
from mien_training.networks import weight_reader
from mien_training.networks.round_weights import rounded

ROOT = Path(__file__).resolve().parents[2]

# multiply-accumulates a step, as published within 3 %
COSTS = {"encoder": 146.8e3, "controls": 39.0e3, "activity": 38.0e3}


def random_encoder(seed=1):
    torch.manual_seed(seed)
    encoder = audio_net.Encoder()
    encoder.mean.normal_(0, 5)
    encoder.deviation.uniform_(0.5, 9)
    with torch.no_grad():
        for c in encoder.convolutions:
            c.norm.running_mean.normal_()
            c.norm.running_var.uniform_(0.5, 2)
            c.norm.weight.uniform_(0.5, 2)
            c.norm.bias.normal_()
    return encoder.eval()


def random_jaw_decoder(seed=1):
    torch.manual_seed(seed)
    decoder = jaw.JawDecoder()
    decoder.mean.normal_(0, 2)
    decoder.deviation.uniform_(0.5, 4)
    return decoder.eval()


def macs(module):
    return sum(p.numel() for n, p in module.named_parameters() if "weight" in n and "norm" not in n)


class Features(unittest.TestCase):
    def test_as_the_independent_implementation(self):
        golden = ROOT / "tests/golden/audio"
        sound = np.fromfile(golden / "mfcc_input.f32", np.float32).reshape(5, -1)
        truth = np.fromfile(golden / "mfcc_output.f32", np.float32).reshape(5, -1, features.BANDS)
        np.testing.assert_allclose(features.mfcc(sound), truth, rtol=1e-4, atol=1e-4 * np.abs(truth).max())

    def test_five_windows_oldest_first_after_silence(self):
        sound = np.float32(np.random.default_rng(1).standard_normal(256 * 8) * 0.1)
        x = features.features(sound)
        coefficients = features.mfcc(features.without_offset(sound))
        silence = features.mfcc(np.zeros(256, np.float32))[0]
        self.assertEqual((8, 130), x.shape)
        np.testing.assert_allclose(x[0], np.concatenate([*[silence] * 4, coefficients[0]]), atol=1e-3)
        np.testing.assert_allclose(x[6], coefficients[2:7].reshape(-1), atol=1e-3)

    def test_an_offset_is_not_heard(self):
        sound = np.float32(np.random.default_rng(1).standard_normal(256 * 100) * 0.1)
        difference = features.features(sound + np.float32(0.2)) - features.features(sound)
        self.assertLess(np.abs(difference[50:]).max(), 0.1)


class Energies(unittest.TestCase):
    def test_do_not_depend_on_the_distance_to_the_microphone(self):
        sound = golden_outputs.some_sound(200)
        near, far = (jaw.relative(jaw.energies(sound * gain)) for gain in (1, 0.3))
        self.assertLess(np.abs(near - far)[100:].mean(), 0.3)
        self.assertGreater(np.abs(jaw.energies(sound) - jaw.energies(sound * 0.3))[100:].mean(), 1.5)

    def test_are_those_of_the_coefficients(self):
        sound = golden_outputs.some_sound(20)
        cosines = features.tables()[2]
        np.testing.assert_allclose(jaw.energies(sound) @ cosines, features.features(sound)[:, -features.BANDS:],
                                   rtol=1e-4, atol=1e-3)


class Network(unittest.TestCase):
    def test_cost_is_the_published(self):
        parts = {"encoder": random_encoder(), "controls": audio_net.controls_decoder(),
                 "activity": audio_net.activity_decoder()}
        for name, part in parts.items():
            self.assertLess(abs(macs(part) / COSTS[name] - 1), 0.03, name)

    def test_streaming_is_the_whole(self):
        for part, inputs in ((random_encoder(), 130), (audio_net.controls_decoder(), 80), (audio_net.activity_decoder(),
                                                                                           80)):
            x = torch.randn(2, 30, inputs)
            with torch.no_grad():
                whole, state, pieces = part(x)[0], None, []
                for piece in x.split([1, 2, 7, 1, 19], 1):
                    y, state = part(piece, state)
                    pieces.append(y)
            torch.testing.assert_close(whole, torch.cat(pieces, 1), atol=1e-5, rtol=1e-4)

    def test_folding_is_exact_from_the_first_step(self):
        encoder = random_encoder()
        decoders = {"controls": audio_net.controls_decoder(), "activity": audio_net.activity_decoder()}
        x = golden_outputs.some_features(200)
        said = export.whole(encoder, decoders, x)
        torch.testing.assert_close(export.folded(encoder, x), said[0], atol=1e-4, rtol=0)
        with tempfile.NamedTemporaryFile(suffix=".mien") as file:
            write_whole(file.name, rounded(export.audionet(encoder, decoders, {"seconds_heard": 1}).to_bytes()))
            self.assertLess(max(export.differences(said, golden_outputs.outputs(file.name, x))[1:]), 0.02)

    def test_the_file_has_the_networks_and_the_mix(self):
        decoders = {"controls": audio_net.controls_decoder(), "activity": audio_net.activity_decoder()}
        file = export.audionet(random_encoder(), decoders, {"seconds_heard": 1})
        self.assertLess(len(file.to_bytes()), 470_000)
        self.assertEqual(set(SPEECH_CONTROLS), set(export.FROM_SOUND))

    def test_a_jaw_decoder_changes_only_jaw_open(self):
        decoders = {"controls": audio_net.controls_decoder(), "activity": audio_net.activity_decoder()}
        decoder, x, energies = random_jaw_decoder(), golden_outputs.some_features(60), golden_outputs.some_energies(60)
        with tempfile.TemporaryDirectory() as folder:
            before, after, again = (Path(folder) / name for name in ("before.mien", "after.mien", "again.mien"))
            write_whole(before, export.audionet(random_encoder(), decoders, {"seconds_heard": 7}).to_bytes())
            write_whole(after, add_jaw.with_jaw(before, decoder).to_bytes())
            write_whole(again, add_jaw.with_jaw(after, decoder).to_bytes())
            self.assertEqual(after.read_bytes(), again.read_bytes())
            self.assertEqual(weight_reader.metadata(before), weight_reader.metadata(after))
            old, new = (golden_outputs.outputs(path, x, energies) for path in (before, after))
        inputs = torch.cat([new[0], torch.from_numpy(jaw.relative(energies[0].numpy()))[None]], -1)
        with torch.no_grad():
            torch.testing.assert_close(decoder(inputs)[0].clamp(0, 1), new[1][..., audio_net.JAW], atol=0.01, rtol=0.01)
        self.assertTrue(torch.equal(old[0], new[0]) and torch.equal(old[2], new[2]))
        self.assertTrue(torch.equal(old[1][..., 1:], new[1][..., 1:]))

    def test_training_goes_on_from_the_file(self):
        encoder = random_encoder()
        decoders = {"controls": audio_net.controls_decoder(), "activity": audio_net.activity_decoder()}
        with tempfile.NamedTemporaryFile(suffix=".mien") as file:
            export.audionet(encoder, decoders, {"seconds_heard": 1}).write(file.name)
            read = weight_reader.networks(file.name)
        x = torch.randn(1, 20, audio_net.EMBEDDING)
        torch.testing.assert_close(decoders["controls"](x)[0].clamp(0, 1),
                                   warm_start.decoder_of(audio_net.controls_decoder(),
                                                         read["controls_decoder"])(x)[0].clamp(0, 1),
                                   atol=0.01, rtol=0.01)
        for (weight, bias), layer, conv in zip(encoder.folded(), read["encoder"], encoder.convolutions):
            torch.testing.assert_close(weight, warm_start.split_causal(layer, conv.convolution.in_channels), atol=1e-3,
                                       rtol=1e-3)
            torch.testing.assert_close(bias, layer.bias, atol=1e-2, rtol=1e-3)


class Labels(unittest.TestCase):
    def test_ipa(self):
        names = lambda text: [phonemes.NAMES[p] for p in phonemes.of_ipa(text)]
        self.assertEqual(["ay"], names("aɪ"))
        self.assertEqual(["ih", "r"], names("ɪɹ"))
        self.assertEqual(["ch"], names("tʃ"))
        self.assertEqual([], names("(de)"))

    def test_a_part_played_faster(self):
        spoken = labels.Spoken([1, 2, 3], [0.0, 1.0, 2.0], 3.0).between(0.5, 2.5, 2.0)
        self.assertEqual(labels.Spoken([1, 2, 3], [0.0, 0.25, 0.75], 1.0), spoken)
        self.assertEqual([1, 2, 3, 0], spoken.at(np.array([0.1, 0.3, 0.8, 1.2])).tolist())

    def test_distance(self):
        self.assertEqual(0, recognition.distance([1, 2], [1, 2]))
        self.assertEqual(3, recognition.distance([1, 2, 3, 4, 5, 6, 7], [9, 2, 3, 4, 8, 7]))
        self.assertEqual(2, recognition.distance([], [1, 1]))

    def test_alignment_finds_times_and_skips_pauses_that_are_none(self):
        said = [0] * 5 + [7] * 10 + [9] * 10 + [0] * 5 + [11] * 10 + [0] * 5
        scores = np.full((len(said), 40), -5.0)
        scores[np.arange(len(said)), said] = 0
        spoken = align.timed(scores, [(7,), (9,), (11,)], len(said) * 0.016)
        self.assertEqual([0, 7, 9, 0, 11, 0], spoken.labels)
        np.testing.assert_allclose(spoken.starts[1:], (np.array([5, 15, 25, 30, 40]) - 2) * 0.016)


class Curves(unittest.TestCase):
    def curve(self, *said, each=0.1):
        ids = [phonemes.INDEX[p] for p in said]
        spoken = labels.Spoken(ids, [each * k for k in range(len(ids))], each * len(ids))
        middles = each * (np.arange(len(ids)) + 0.5)
        return dict(zip(SPEECH_CONTROLS, visemes.curves(spoken, middles).T))

    def test_lips_close_for_bilabials(self):
        for lips in "pbm":
            self.assertLess(self.curve("aa", lips, "aa")["jawOpen"][1], 0.15)
            self.assertGreater(self.curve("aa", "aa", "aa")["jawOpen"][1], 0.3)

    def test_rounding_begins_in_the_consonant_before(self):
        self.assertGreater(self.curve("s", "t", "uw")["mouthPucker"][1],
                           self.curve("s", "t", "iy")["mouthPucker"][1] + 0.1)

    def test_silence_is_rest(self):
        silence = labels.Spoken([0], [0.0], 1.0)
        self.assertFalse(visemes.curves(silence, np.linspace(0, 1, 20)).any())


class Sound(unittest.TestCase):
    def test_activity_bridges_stops_and_not_pauses(self):
        rng = np.random.default_rng(1)
        sound = np.float32(1e-4 * rng.standard_normal(4 * 16000))
        for a, b in ((0.5, 1.0), (1.08, 1.5), (2.5, 3.0)):
            sound[int(16000 * a):int(16000 * b)] += np.float32(0.1
                                                               * rng.standard_normal(int(16000 * b) - int(16000 * a)))
        heard = activity.at(activity.of_windows(sound), np.array([0.2, 0.8, 1.04, 1.3, 2.0, 2.8, 3.5]))
        self.assertEqual([False, True, True, True, False, True, False], heard.tolist())

    def test_noise_comes_at_its_ratio(self):
        rng = np.random.default_rng(1)
        sound, noise = (np.float32(rng.standard_normal(16000)) for _ in range(2))
        added = effects.mixed(sound, noise, 10) - sound
        self.assertAlmostEqual(10, 10 * np.log10(effects.speech_power(sound) / effects.power(added)), places=3)

    def test_companding_changes_little(self):
        sound = np.linspace(-1, 1, 101, dtype=np.float32)
        self.assertLess(np.abs(effects.mu_law(sound) - sound).max(), 0.03)

    def test_codecs_keep_time(self):
        t = np.arange(32000) / 16000
        vowel = sum(np.sin(2 * np.pi * 130 * k * t) / k for k in range(1, 15))
        sound = np.float32(0.2 * vowel * (np.sin(2 * np.pi * (2 + t) * t) > 0.3))
        envelope = lambda x: np.convolve(np.abs(x), np.ones(80), "same")
        for coded in (opus.coded(sound, 16000), effects.adpcm(sound)):
            self.assertEqual(len(sound), len(coded))
            lags = range(-200, 201, 4)
            matches = [np.dot(envelope(sound), np.roll(envelope(coded), lag)) for lag in lags]
            self.assertLess(abs(lags[int(np.argmax(matches))]), 48)  # 3 ms


if __name__ == "__main__":
    unittest.main()
