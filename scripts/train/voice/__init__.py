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

Minutes are of a share of one busy CPU core. What is learnt from is in scenes.py and effects.py; what was held out, in corpus.py.
"""
