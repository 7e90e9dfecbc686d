"""AudioNet, from audio to controls (Navarro et al. 2023): data, training and export. The order of its programs:

    A="python3 -m mien_training.audio" R=${MIEN_CACHE:-~/.cache/mien}/runs
    $A.corpus                                  # all audio of the data packs, decoded once
    $A.make_speech --hours 6                   # synthetic speech with exact times
    $A.transcribe                              # words of speech that has no transcript
    $A.warm_start --out $R/committed.pt        # from models/audionet.mien
    $A.align $R/committed.pt
    T="$A.train_encoder --name audionet --together --reuse 3 --rate 3.5e-3 --hard 0.7 --workers 1 --validate 8"
    $T --start-from $R/committed.pt --minutes 82   # stop it twice, after a validation, to align with audionet/last.pt
    $A.train_decoders $R/audionet/last.pt --out $R/audionet_decoders.pt
    $A.export $R/audionet/last.pt $R/audionet_decoders.pt
    $A.train_jaw --out $R/jaw.pt               # on the encoder of models/audionet.mien
    $A.add_jaw $R/jaw.pt
    $A.golden_outputs                          # expected outputs of a test
    python3 -m mien_training.evaluate audio

Without weights to start from: --synthetic-only --minutes 8 --rate 5e-3 --hard 0.4 without --together trains an encoder
that can align. Minutes are those of one and a half CPU cores. examples.py and effects.py define the training data,
corpus.py the held-out data.
"""
