// Types of mien.js. Terms, units and ranges are those of mien.h, which documents them.

export type ImageFormat = 'gray8' | 'rgb' | 'bgr' | 'rgba' | 'bgra' | 'nv12' | 'nv21' | 'i420';
export type FaceStatus = 'searching' | 'tracking' | 'lost';
export type StageName = 'proposal' | 'warp' | 'encoder' | 'heads' | 'decoders' | 'sound';
/** 1 (fastest) to 4 (most accurate); 0: automatic, the highest within budgetMs per frame. */
export type LevelOfDetail = 0 | 1 | 2 | 3 | 4;
export type Bytes = ArrayBuffer | ArrayBufferView;
/** Nanoseconds on one clock for images and audio. */
export type Nanoseconds = bigint | number;

/** ARKit's names of the controls. */
export type ControlName =
  | 'eyeBlinkLeft' | 'eyeLookDownLeft' | 'eyeLookInLeft' | 'eyeLookOutLeft' | 'eyeLookUpLeft' | 'eyeSquintLeft' | 'eyeWideLeft'
  | 'eyeBlinkRight' | 'eyeLookDownRight' | 'eyeLookInRight' | 'eyeLookOutRight' | 'eyeLookUpRight' | 'eyeSquintRight' | 'eyeWideRight'
  | 'jawForward' | 'jawLeft' | 'jawRight' | 'jawOpen' | 'mouthClose' | 'mouthFunnel' | 'mouthPucker' | 'mouthLeft' | 'mouthRight'
  | 'mouthSmileLeft' | 'mouthSmileRight' | 'mouthFrownLeft' | 'mouthFrownRight' | 'mouthDimpleLeft' | 'mouthDimpleRight' | 'mouthStretchLeft'
  | 'mouthStretchRight' | 'mouthRollLower' | 'mouthRollUpper' | 'mouthShrugLower' | 'mouthShrugUpper' | 'mouthPressLeft' | 'mouthPressRight'
  | 'mouthLowerDownLeft' | 'mouthLowerDownRight' | 'mouthUpperUpLeft' | 'mouthUpperUpRight' | 'browDownLeft' | 'browDownRight' | 'browInnerUp'
  | 'browOuterUpLeft' | 'browOuterUpRight' | 'cheekPuff' | 'cheekSquintLeft' | 'cheekSquintRight' | 'noseSneerLeft' | 'noseSneerRight'
  | 'tongueOut';

/** Groups of landmarks; mien_landmark_group of mien.h describes them. */
export type LandmarkGroupName =
  | 'right_eye_lower' | 'left_eye_lower' | 'right_eye_upper' | 'left_eye_upper' | 'right_iris' | 'left_iris' | 'right_brow_upper'
  | 'left_brow_upper' | 'right_brow_lower' | 'left_brow_lower' | 'right_nose_side' | 'left_nose_side' | 'right_cheek' | 'left_cheek'
  | 'nose_bridge' | 'midline' | 'lips_outer_upper' | 'lips_outer_lower' | 'lips_inner_upper' | 'lips_inner_lower' | 'face_oval';

/** The error of all functions; `status` is the mien_status, if the library returned one. */
export class MienError extends Error {
  readonly status?: number;
  constructor(message: string, status?: number);
}

/** Opened weight files, copied into the module. Trackers and networks share them, and keep what they use after destroy. */
export class Weights {
  private constructor();
  destroy(): void;
}

/** Missing fields have the defaults of mien_tracker_config_default. */
export interface TrackerConfig {
  /** Levels of detail 2 to 4 need HiFiNet among them, audio needs AudioNet. */
  weights: Weights;
  /** Default 1. */
  lod?: LevelOfDetail;
  /** Highest level of detail that the tracker will use; 1 saves the memory of HiFiNet. */
  maxLod?: 1 | 2 | 3 | 4;
  /** Accepts audio if the weights have AudioNet; default true. */
  audio?: boolean;
  /** MIEN_CPU_* bits. */
  cpuMask?: number;
  /** Horizontal field of view of the upright image for images without focalLengthPx, radians, 0.01..3.1; default pi / 3. */
  horizontalFov?: number;
  /** Minimum probability of a detection that becomes a tracked face, 0..1; default 0.999. */
  acceptProbability?: number;
  /** Face probability below which a tracked face counts as missed, 0..acceptProbability; default 0.5. */
  loseProbability?: number;
  /** Consecutive misses after which a face is lost, 1..1000; default 3. */
  loseAfterFrames?: number;
  /** Pixels to which detection scales the longer side of the image, 24..640; default 160. */
  proposalSize?: number;
  /** Threshold of P-Net, 0..1; default 0.4. */
  proposalThreshold?: number;
  /** Threshold of R-Net, 0..1; default 0.2. */
  refineThreshold?: number;
  /** Frames between detections in the whole image, 1..1000; default 3. */
  searchInterval?: number;
  /** Average time budget of a frame with a face for the automatic level, ms, 0.01..1e6; default 10. */
  budgetMs?: number;
  /** Smooths controls, landmarks and pose while they hardly move; default true. */
  smoothing?: boolean;
  /** Maximum number of faces, 1..8; default 1. */
  maxFaces?: number;
  /** Time constant with which voice activity rises, ms, 0..10000; default 40. */
  voiceAttackMs?: number;
  /** Time constant with which voice activity falls, ms, 0..10000; default 150. */
  voiceReleaseMs?: number;
  /** Factor of the controls predicted from audio, 0..4; default 1. */
  voiceStrength?: number;
}

/** `data` with the planes one after another and no padding (for example an ImageData), or `planes`. The default of `format` is 'rgba'. */
export interface Image {
  format?: ImageFormat;
  /** Pixels of the buffer, before rotation, 1..16384. */
  width: number;
  /** Pixels of the buffer, before rotation, 1..16384. */
  height: number;
  data?: Uint8Array | Uint8ClampedArray;
  planes?: (Uint8Array | Uint8ClampedArray)[];
  /** For each plane, bytes from the start of a row to that of the row below. */
  rowStrideBytes?: number[];
  /** I420: bytes from one sample of U or V to the next; 0 means 1. */
  chromaPixelStrideBytes?: number;
  /** Clockwise rotation to upright, degrees. */
  rotation?: 0 | 90 | 180 | 270;
  /** The image mirrors the scene (selfie camera). */
  mirrored?: boolean;
  /** Grey and YUV: luma 0..255, the default; otherwise video range, 16..235. */
  fullRange?: boolean;
  /** YUV uses BT.709; otherwise BT.601. */
  bt709?: boolean;
  /** Region of interest: x, y, width, height in pixels of the buffer before rotation; nothing outside it is read. */
  region?: [number, number, number, number];
  /** Pixels of the upright image; 0: unknown, horizontalFov applies. */
  focalLengthPx?: number;
  /** Principal point in pixels of the upright image; both 0: the centre. */
  principalX?: number;
  principalY?: number;
  /** Width of a pixel / its height, 0.1 to 10; results are in square pixels: the upright image keeps its height. */
  pixelAspect?: number;
}

/** One face on one frame. */
export interface Result {
  status: FaceStatus;
  /** Timestamp of the frame. */
  ptsNs: bigint;
  /** Bit i: control i is supported. */
  supportedControls: bigint;
  /** 0..1, of the latest crop. */
  faceProbability: number;
  /** 0..1; 0 without audio. */
  voiceActivity: number;
  /** Level of detail of the frame, 1..4. */
  lod: number;
  /** MIEN_RESULT_*. */
  flags: number;
  /** x, y, width, height in pixels of the upright image. */
  box: Float32Array;
  /** Head to camera: unit quaternion x, y, z, w. */
  rotation: Float32Array;
  /** Radians, positive: looks down. */
  pitch: number;
  /** Radians, positive: turns to the subject's left. */
  yaw: number;
  /** Radians, about z by the right-hand rule. */
  roll: number;
  /** Metres, x, y, z: the head in camera space. */
  translation: Float32Array;
  /** 52, each 0..1, in the order of Mien.controlNames: controls[mien.control.jawOpen]. */
  controls: Float32Array;
  /** 15 visemes of OVR LipSync (Oculus): sil PP FF TH DD kk CH SS nn RR aa E ih oh ou; their sum is 1. */
  visemes: Float32Array;
  /** Bit i: viseme i is supported. */
  supportedVisemes: number;
  /** x, y of 175 points in pixels of the upright image. */
  landmarks: Float32Array;
  /** Since create or reset: frames with and without an image. */
  frames: bigint;
  /** Since create or reset: frames with a tracked face. */
  faceFrames: bigint;
  /** Since create or reset: detections in the whole image. */
  proposalRuns: bigint;
  /** Since create or reset: runs of BaseNet and HiFiNet. */
  encoderRuns: bigint;
  /** Nanoseconds in each stage on this frame. */
  stageNs: Record<StageName, number>;
  /** Number of the face, from 1 in the order of detection; 0 before the first. */
  faceId: number;
}

/** Sources of pixels in browsers, and pixels in memory. */
export type FrameSource = HTMLVideoElement | HTMLImageElement | VideoFrame | ImageBitmap | HTMLCanvasElement | OffscreenCanvas | ImageData | Image;

export class Tracker {
  private constructor();
  /** The module of the tracker: names of controls, stages and landmarks. */
  readonly mien: Mien;
  /**
   * Tracks one source after another, in the order of the calls. The source remains the caller's: close a VideoFrame or ImageBitmap after the result.
   * @param ptsNs default: the timestamp of a VideoFrame, otherwise performance.now()
   */
  track(source: FrameSource, ptsNs?: Nanoseconds): Promise<Result>;
  /** Takes audio from the port of an audio worklet (mien-worklet.js); the next track() reports an error in it. `listen` connects it. */
  connectAudio(port: MessagePort): void;
  /** Tracks one image; `ptsNs` is its timestamp. */
  pushVideo(image: Image, ptsNs: Nanoseconds): void;
  /** Float32 -1..1 or int16, channels interleaved; `ptsNs` is the time of the first sample. `sampleRate`: 8000..192000 Hz; `channels`: 1..8, default 1. */
  pushAudio(samples: Float32Array | Int16Array, format: {sampleRate: number; channels?: number}, ptsNs: Nanoseconds): void;
  /** Outputs a frame without an image, for audio without video. */
  advance(ptsNs: Nanoseconds): void;
  /** The result of the latest frame, of the face with the lowest id. */
  getResult(): Result;
  /** Number of known faces, 0..maxFaces. */
  faceCount(): number;
  /** `index`: 0..faceCount() - 1, in the order of ids. */
  getFace(index: number): Result;
  /** Takes effect from the next image on. */
  setLod(lod: LevelOfDetail): void;
  /** Delays audio relative to the images: nanoseconds added to its timestamps, for audio pushed from now on. */
  setAudioOffset(offsetNs: Nanoseconds): void;
  /** Weights of audio and video for a control during speech, each 0..1. */
  setMix(control: ControlName | number, audioWeight: number, videoWeight: number): void;
  /** Captures a person's neutral controls over the next 55 frames with a face, and removes them from later frames. */
  captureNeutral(): void;
  /** The captured neutral values as a file of 448 bytes. `captured`: bit 0: level 1; bit 1: levels 2 to 4. */
  saveNeutral(): {file: Uint8Array; captured: number};
  /** Restores saved neutral values. */
  loadNeutral(file: Bytes): void;
  /** Resets the tracker to its state after creation. */
  reset(): void;
  /** Releases all memory; no other call is allowed afterwards. */
  destroy(): void;
}

/** Shape of a map in rows, columns and channels. */
export interface Shape {
  height: number;
  width: number;
  channels: number;
}

/** Views of the module's memory, valid until the module creates another object. */
export interface TensorView {
  data: Float32Array;
  shape: Shape;
}

/** A custom network of a weight file; mien_network of mien.h documents the layout of maps. */
export class Network {
  private constructor();
  input(): TensorView;
  /** Runs the network once, one step of a temporal network. */
  run(): void;
  outputCount(): number;
  /** `index`: 0..outputCount() - 1. */
  output(index: number): TensorView;
  /** Resets the state of temporal layers to the start of a stream. */
  reset(): void;
  destroy(): void;
}

export class Mien {
  private constructor();
  readonly version: string;
  readonly controlNames: ControlName[];
  /** Index of each control: controls[mien.control.jawOpen]. */
  readonly control: Readonly<Record<ControlName, number>>;
  /** Index of each group's first landmark, and number of its landmarks. */
  readonly landmarkGroups: Readonly<Record<LandmarkGroupName, {readonly first: number; readonly count: number}>>;
  readonly stageNames: StageName[];
  /** 175. */
  readonly landmarkCount: number;
  /** Each file is a weight file, a packed one, or a bundle of several, in any order. */
  createWeights(files: Bytes[]): Weights;
  createTracker(config: TrackerConfig): Tracker;
  /** `name`: default: the first network. `height`, `width`: size of the input, for networks that accept several; default: the declared size. */
  createNetwork(config: {weights: Weights; name?: string; height?: number; width?: number; cpuMask?: number}): Network;
}

/** `source`: URL of mien.wasm, a Response with it, its bytes, or the compiled module; default: the file of this package. */
export function loadMien(source?: string | URL | Response | Bytes | WebAssembly.Module): Promise<Mien>;

/** Fields of TrackerConfig; `lod` is 0, automatic, by default. */
export interface TrackerOptions extends Omit<TrackerConfig, 'weights'> {
  /** URL of a folder with mien.wasm and models/; default: the files of this package. */
  folder?: string | URL;
}

/** A tracker with the files of this package. HiFiNet is loaded unless `maxLod` is 1, AudioNet unless `audio` is false. */
export function createTracker(options?: TrackerOptions): Promise<Tracker>;

type Promised<F> = F extends (...args: infer A) => infer R ? (...args: A) => Promise<Awaited<R>> : never;
type Forwarded = 'track' | 'connectAudio' | 'pushAudio' | 'advance' | 'getResult' | 'faceCount' | 'getFace' | 'setLod' | 'setAudioOffset' | 'setMix' | 'captureNeutral' |
  'saveNeutral' | 'loadNeutral' | 'reset';

/** A tracker in a worker: the methods of Tracker, which return promises. */
export interface TrackerWorker extends Readonly<{[Method in Forwarded]: Promised<Tracker[Method]>}> {
  readonly version: string;
  /** Ends the worker; promises that are pending are rejected. */
  destroy(): void;
}

/** `worker`: one that runs mien-worker.js of this package; default: a new one. */
export function createTrackerWorker(options?: TrackerOptions & {worker?: Worker}): Promise<TrackerWorker>;

/** Sends audio to a tracker through an AudioWorklet. A new AudioContext starts after the first click or key of the user. */
export function listen(tracker: Tracker | TrackerWorker, source: MediaStream | AudioNode, options?: {context?: AudioContext}):
  Promise<{readonly context: BaseAudioContext; stop(): void}>;

/** Names of controls in other blendshape standards, as in mien_vocabulary of mien.h; 'visemes' are those of Oculus. */
export type Vocabulary = 'arkit' | 'mediapipe' | 'roblox' | 'vrm0' | 'vrm1' | 'visemes';

/** The controls that the level of detail predicts, by name, 0..1. */
export function controlsByName(result: Pick<Result, 'controls' | 'supportedControls'>): Partial<Record<ControlName, number>>;
/** The same in another vocabulary. */
export function controlsByName(result: Pick<Result, 'controls' | 'supportedControls' | 'visemes' | 'supportedVisemes'>, vocabulary: Vocabulary): Record<string, number>;

/** An Object3D of three.js: the members that are used. */
export interface Morphs {
  traverse(visit: (node: any) => void): void;
}

/** A VRM of @pixiv/three-vrm: the members that are used. */
export interface VRMAvatar {
  expressionManager?: any;
  humanoid?: any;
  meta?: any;
}

/**
 * Sets the morph targets of a mesh or group of three.js whose names are those of ARKit (which are MediaPipe's) or Roblox, in any case, with _L and _R
 * and behind a prefix: Face.jawOpen, or Head_jawOpen if at least three names share Head_. If none of them opens the jaw, at least three names of
 * Oculus (viseme_aa, v_aa, aa), VRM or VRoid move the mouth. Controls that are not predicted count as 0. The names of an object are read once.
 * @returns number of morph targets that were set
 */
export function applyToMorphs(root: Morphs, result: Pick<Result, 'controls'> & Partial<Pick<Result, 'visemes'>>): number;

/**
 * Sets the expressions of a VRM avatar, its presets or, if it has them, those with ARKit's names, and turns its head.
 * Call vrm.update afterwards.
 * @returns number of expressions that were set
 */
export function applyToVRM(vrm: VRMAvatar, result: Pick<Result, 'controls' | 'rotation'>): number;
