"""Sound to controls (a2c): data, training and export of AudioNet (Navarro et al. 2023). Run in scripts/train, in this order:

    python3 -m voice.corpus                                # all sound of the data packs, decoded once
    python3 -m voice.make_speech --hours 6                 # synthetic speech with exact times
    python3 -m voice.transcribe                            # words of speech that has no transcript
    R=${MIEN_CACHE:-~/.cache/mien}/runs
    python3 -m voice.warm_start --out $R/committed.pt      # from models/audionet.mien
    python3 -m voice.align $R/committed.pt
    T="python3 -m voice.train_encoder --name audionet --together --reuse 3 --rate 3.5e-3 --hard 0.7 --workers 1 --validate 8"
    $T --start-from $R/committed.pt --minutes 82           # stop it twice, after a validation, to align anew with $R/audionet/last.pt
    python3 -m voice.train_decoders $R/audionet/last.pt --out $R/audionet_decoders.pt
    python3 -m voice.export $R/audionet/last.pt $R/audionet_decoders.pt
    python3 -m voice.golden                                # what a test holds the file against
    ../evaluate/evaluate.py voice --audionet $R/audionet/last.pt $R/audionet_decoders.pt

Without weights to start from: --synthetic-only --minutes 8 --rate 5e-3 --hard 0.4 without --together makes an encoder that can align.
Minutes are of one and a half busy CPU cores. What is learnt from is in scenes.py and effects.py; what was held out, in corpus.py.
"""
