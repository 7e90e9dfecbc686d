"""Sound to controls (a2c): data, training and export of AudioNet (Navarro et al. 2023). Run in scripts/train, in this order:

    python3 -m voice.corpus                                # all sound of the data packs, decoded once
    python3 -m voice.make_speech                           # synthetic speech with exact times
    R=${MIEN_CACHE:-~/.cache/mien}/runs
    T="python3 -m voice.train_encoder"
    $T --name audionet_synthetic --synthetic-only --minutes 8 --rate 5e-3 --hard 0.4
    python3 -m voice.align $R/audionet_synthetic/last.pt --groups librispeech_text av
    $T --name audionet_text --start-from $R/audionet_synthetic/last.pt --minutes 10 --rate 4e-3 --hard 0.6
    python3 -m voice.align $R/audionet_text/last.pt        # and labels for what has no transcript
    $T --name audionet --start-from $R/audionet_text/last.pt --together --reuse 2 --minutes 40 --rate 4e-3 --hard 0.7
    python3 -m voice.train_decoders $R/audionet/last.pt --out $R/audionet_decoders.pt
    python3 -m voice.export $R/audionet/last.pt $R/audionet_decoders.pt
    ../evaluate/voice_report.py $R/audionet/last.pt $R/audionet_decoders.pt

The weights in models/ were made so but in more legs: 11 of the last 40 minutes of phase 1 without --together, labels aligned once
more after them, 27 minutes together (137 hours of sound in all; the file counts 98), and phase 2 for 7 minutes at rate 2e-3 with a pool
of 700. Until 12 minutes into the leg together, voice activity's truth was all within 30 dB, which takes GRID's noise for speech.
Warping (features.py) came after them: a warm restart of 8.5 minutes with it and with labels aligned anew did not pay on validation
(readers 36.2 % instead of 35.4 %, synthetic voices 17.5 % instead of 16.4 %).

Minutes are of a share of one busy CPU core. What is learnt from is in scenes.py and effects.py; what was held out, in corpus.py.
"""
