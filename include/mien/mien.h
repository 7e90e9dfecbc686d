/* mien: facial animation from video and sound on a phone's CPU. The public C interface.
 *
 * Words
 *   upright image  the pushed buffer turned clockwise by `rotation`. Its pixel (column, row) covers
 *                  [column, column + 1) x [row, row + 1); its centre lies at
 *                  (column + 0.5, row + 0.5). A mirrored picture stays mirrored: results can
 *                  be drawn on it as it is.
 *   left, right    the subject's.
 *   control        one animation weight in 0..1 with an ARKit name (mien_control_name).
 *   camera space   right-handed: x to the right, y up, z towards the viewer; the camera looks
 *                  along -z. Metres. Of the scene itself: a mirrored picture is un-mirrored for
 *                  the head pose.
 *   head space     x to the subject's left, y up, z out of the face; origin between the ears.
 *
 * Structs
 *   `struct_size` comes first in every struct and is set by the caller to sizeof(the struct); the
 *   *_default functions do so. A shorter struct (compiled with an older header) is read or written
 *   as far as it reaches: the missing inputs take their defaults. Of a longer one, the unknown tail
 *   is ignored on input and zeroed on output. Reserved fields must be zero.
 *
 * Threads
 *   Functions without a tracker argument may be called from anywhere at any time. A tracker may be
 *   used by one thread at a time, and by another that does nothing but mien_tracker_queue_audio;
 *   different trackers are independent. No function locks, prints,
 *   opens files, starts threads or (except create and destroy, through the allocator) allocates.
 *
 * Floating point
 *   Rounding, traps and the treatment of denormal numbers may be as the caller likes: results do
 *   not depend on them, and the caller finds them, and the sticky flags, as they were. Callbacks
 *   run in the library's own state: to nearest, nothing trapped, denormal numbers as zero.
 *
 * Stack
 *   Create and required_bytes need up to 96 KiB of it, all else up to 16 KiB.
 *
 * Errors
 *   A function that returns a mien_status does nothing else when the status is not MIEN_OK, unless
 *   it says so. Numbers are never reused.
 */
#ifndef MIEN_MIEN_H_
#define MIEN_MIEN_H_

#include <stddef.h>
#include <stdint.h>

#if defined(MIEN_SHARED) && defined(_WIN32)
#ifdef MIEN_BUILDING
#define MIEN_API __declspec(dllexport)
#else
#define MIEN_API __declspec(dllimport)
#endif
#elif defined(__GNUC__) && !defined(_WIN32)
#define MIEN_API __attribute__((visibility("default")))
#else
#define MIEN_API
#endif

#if defined(__GNUC__)
#define MIEN_NODISCARD __attribute__((warn_unused_result))
#else
#define MIEN_NODISCARD
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define MIEN_API_VERSION 0x00000100 /* 0x00XXYYZZ: major, minor, patch */

#define MIEN_CONTROL_COUNT 52
#define MIEN_LANDMARK_COUNT 175
#define MIEN_MAX_STAGES 16

/* Alignment in bytes of weight files in memory and of the memory given to mien_tracker_create_in.
 */
#define MIEN_ALIGNMENT 64

/* Status --------------------------------------------------------------------------------------- */

typedef enum mien_status {
  MIEN_OK = 0,
  /* arguments */
  MIEN_ERROR_NULL_ARGUMENT = -1,
  MIEN_ERROR_STRUCT_SIZE = -2,      /* struct_size is too small to hold what is indispensable */
  MIEN_ERROR_OUT_OF_RANGE = -3,     /* a value lies outside its documented range, or is NaN */
  MIEN_ERROR_ALIGNMENT = -4,        /* weights, memory or samples are not aligned as they must be */
  MIEN_ERROR_MEMORY_TOO_SMALL = -5, /* less than mien_tracker_required_bytes */
  MIEN_ERROR_OUT_OF_MEMORY = -6,    /* the allocator returned NULL */
  MIEN_ERROR_UNSUPPORTED_LOD = -7,
  MIEN_ERROR_SEVERAL_FACES = -8, /* of a tracker for one face only */
  MIEN_ERROR_NO_AUDIONET = -9,   /* sound, for a tracker without weights for it */
  /* weight files */
  MIEN_ERROR_WEIGHTS_NOT_MIEN = -20,   /* not a .mien file */
  MIEN_ERROR_WEIGHTS_VERSION = -21,    /* a version of the format that this library does not read */
  MIEN_ERROR_WEIGHTS_TRUNCATED = -22,  /* fewer bytes than the file says */
  MIEN_ERROR_WEIGHTS_CHECKSUM = -23,   /* damaged */
  MIEN_ERROR_WEIGHTS_MALFORMED = -24,  /* breaks another rule of the format */
  MIEN_ERROR_WEIGHTS_INCOMPLETE = -25, /* lacks a network or constant that is needed */
  MIEN_ERROR_WEIGHTS_SHAPE = -26,      /* a network or constant has another shape than needed */
  MIEN_ERROR_WEIGHTS_NOT_PACKED = -27, /* no packed weights */
  /* engine */
  MIEN_ERROR_UNSUPPORTED_CPU = -40,   /* the mask leaves no tier that this CPU and build can run */
  MIEN_ERROR_UNSUPPORTED_LAYER = -41, /* no allowed tier has a kernel for a layer */
  MIEN_ERROR_INTERNAL = -42,          /* a fault of mien itself */
  MIEN_ERROR_LEFT_OUT = -43,          /* this build of the library has no part for that */
  /* stream */
  MIEN_ERROR_IMAGE_FORMAT = -60, /* no mien_image_format, or no mien_yuv_matrix */
  MIEN_ERROR_IMAGE_SIZE = -61,   /* width or height outside 1..MIEN_MAX_IMAGE_SIDE, or
                                  * pixel_aspect outside 0.1..10 */
  MIEN_ERROR_IMAGE_STRIDE = -62, /* rows or chroma samples overlap each other */
  MIEN_ERROR_IMAGE_PLANE = -63,  /* a plane of the format is NULL */
  MIEN_ERROR_IMAGE_ROTATION = -64,
  MIEN_ERROR_IMAGE_CAMERA = -65, /* focal length or principal point negative or not finite */
  MIEN_ERROR_AUDIO_FORMAT = -66,
  MIEN_ERROR_AUDIO_RATE = -67,     /* outside 8000..192000 samples a second */
  MIEN_ERROR_AUDIO_CHANNELS = -68, /* outside 1..MIEN_MAX_AUDIO_CHANNELS */
  MIEN_ERROR_AUDIO_SAMPLES = -69,  /* NULL where there should be samples */
  MIEN_ERROR_IMAGE_REGION = -70,   /* empty, beyond the image, or, of YUV, at an odd place */
  MIEN_ERROR_AUDIO_QUEUE_FULL = -71,
  /* neutral files */
  MIEN_ERROR_NEUTRAL_FORMAT = -80,  /* not a neutral file */
  MIEN_ERROR_NEUTRAL_VERSION = -81, /* a version of the format that this library does not read */
  MIEN_ERROR_NEUTRAL_DAMAGED = -82  /* truncated, too long, or changed */
} mien_status;

/* One line of English, static, never NULL; "unknown status" for numbers that are none. */
MIEN_API const char* mien_status_string(mien_status status);

/* Static string "major.minor.patch" of the library. */
MIEN_API const char* mien_version(void);

/* MIEN_API_VERSION of the header that the library was built with. */
MIEN_API uint32_t mien_version_api(void);

/* CPU ------------------------------------------------------------------------------------------ */

/* One bit per tier of kernels. Numbers are fixed; not every build has every tier. */
#define MIEN_CPU_REF 0x01u /* readable scalar code, slow */
#define MIEN_CPU_AVX2 0x02u
#define MIEN_CPU_AVX512 0x04u
#define MIEN_CPU_NEON 0x08u
#define MIEN_CPU_NEON_FP16 0x10u
#define MIEN_CPU_NEON32 0x20u
#define MIEN_CPU_WASM 0x40u
#define MIEN_CPU_AVX512_FP16 0x80u
#define MIEN_CPU_AVX512_VNNI 0x100u
/* Not one tier but those that compute with 16 bits where it pays: faster, with about three digits,
 * and in half precision only right for networks whose values stay within 65504, as the project's
 * own do. */
#define MIEN_CPU_HALF (MIEN_CPU_NEON_FP16 | MIEN_CPU_AVX512_FP16 | MIEN_CPU_AVX512_VNNI)
/* Not a tier: blocks of layers may run fused, which is faster. Without it each layer runs by
 * itself, with the same results but for rounding. */
#define MIEN_CPU_FUSED 0x80000000u
#define MIEN_CPU_ALL 0xFFFFFFFFu

/* The tiers that this build has and this CPU can run. MIEN_CPU_REF is always among them, unless the
   library was built without it (MIEN_TRIM_REF). */
MIEN_API uint32_t mien_cpu_tiers(void);

/* Name of the tier with the single bit `tier` ("ref", "avx2", ...); NULL for anything else. */
MIEN_API const char* mien_cpu_tier_name(uint32_t tier);

/* Names ---------------------------------------------------------------------------------------- */

/* ARKit name in lowerCamel of control 0..MIEN_CONTROL_COUNT-1 ("eyeBlinkLeft" .. "tongueOut"), in
 * the order of Apple's Live Link wire format; NULL outside. Static. */
MIEN_API const char* mien_control_name(int32_t control);

/* Other vocabularies for the same face: avatars of other houses have names of their own. */
typedef enum mien_vocabulary {
  MIEN_VOCABULARY_ARKIT = 0,     /* 52: the controls as they are */
  MIEN_VOCABULARY_MEDIAPIPE = 1, /* 52: _neutral, always 0, and 51 by the alphabet; no tongueOut */
  MIEN_VOCABULARY_ROBLOX = 2,    /* 50: FACS of Roblox' FaceControls, in the order of the enum */
  MIEN_VOCABULARY_VRM0 = 3,      /* 11: Joy Angry Sorrow Fun A I U E O Blink_L Blink_R */
  MIEN_VOCABULARY_VRM1 = 4,   /* 11: happy angry sad relaxed aa ih ou ee oh blinkLeft blinkRight */
  MIEN_VOCABULARY_VISEMES = 5 /* 15 of OVR LipSync: sil PP FF TH DD kk CH SS nn RR aa E ih oh ou */
} mien_vocabulary;

/* Names in it; 0 for numbers that are no mien_vocabulary. */
MIEN_API int32_t mien_vocabulary_size(int32_t vocabulary);

/* Name 0..mien_vocabulary_size - 1, written as its owner writes it; NULL outside. Static. */
MIEN_API const char* mien_vocabulary_name(int32_t vocabulary, int32_t index);

/* MIEN_CONTROL_COUNT controls in other words: `count`, which has to be mien_vocabulary_size, values
 * in 0..1. Left and right that have one name give their mean; vocabulary_tables.h has every rule.
 * Exact for MediaPipe and nearly so for Roblox; the vowels and moods of VRM are a rough
 * reading of the face. Visemes, whose sum is 1, are the mixture of poses that comes nearest to the
 * mouth (formats/animation/visemes.h), as `mien track --format visemes` writes them. What no
 * control says (FlatPucker, TongueUp, TongueDown, Fun, relaxed) is 0. MIEN_ERROR_OUT_OF_RANGE for
 * another vocabulary or count. */
MIEN_API MIEN_NODISCARD mien_status mien_vocabulary_values(int32_t vocabulary,
                                                           const float* controls, float* values,
                                                           int32_t count);

/* Bit i: name i is driven, where mien_result.supported_controls says so of controls; a viseme where
 * the control is that its pose moves most. */
MIEN_API uint64_t mien_vocabulary_supported(int32_t vocabulary, uint64_t supported_controls);

/* Number of controls / landmarks that this library fills in. */
MIEN_API int32_t mien_control_count(void);
MIEN_API int32_t mien_landmark_count(void);

/* Image ---------------------------------------------------------------------------------------- */

#define MIEN_MAX_IMAGE_SIDE 16384

/* YUV is BT.601 or, where mien_image.yuv_matrix says so, BT.709, chroma subsampled 2 x 2; a chroma
 * plane has (width + 1) / 2 samples in each of its (height + 1) / 2 rows. YV12 is I420 with planes
 * 1 and 2 exchanged. Android's YUV_420_888 is I420 with chroma_pixel_stride_bytes set to the
 * plane's pixel stride. */
typedef enum mien_image_format {
  MIEN_IMAGE_GRAY8 = 0, /* 1 plane */
  MIEN_IMAGE_RGB = 1,   /* 1 plane, 3 bytes a pixel */
  MIEN_IMAGE_BGR = 2,
  MIEN_IMAGE_RGBA = 3, /* 1 plane, 4 bytes a pixel; the fourth is ignored (RGBX, BGRX) */
  MIEN_IMAGE_BGRA = 4,
  MIEN_IMAGE_NV12 = 5, /* 2 planes: Y; U and V interleaved */
  MIEN_IMAGE_NV21 = 6, /* 2 planes: Y; V and U interleaved */
  MIEN_IMAGE_I420 = 7  /* 3 planes: Y; U; V */
} mien_image_format;

/* How YUV was made of colours: cameras and SD video use BT.601, most HD video BT.709. */
typedef enum mien_yuv_matrix { MIEN_YUV_BT601 = 0, MIEN_YUV_BT709 = 1 } mien_yuv_matrix;

/* A picture in the caller's memory, which is read during the call only. Never read: bytes after the
 * last pixel of a row. Start from mien_image_default. */
typedef struct mien_image {
  uint32_t struct_size;
  int32_t format; /* mien_image_format */
  int32_t width;  /* pixels of the buffer, before rotation; 1..MIEN_MAX_IMAGE_SIDE */
  int32_t height;
  const void* planes[3]; /* first byte of the top row; unused planes are ignored */
  /* From one row to the next below it; negative for bottom-up memory. */
  int32_t row_stride_bytes[3];
  int32_t chroma_pixel_stride_bytes; /* I420 only: from one chroma sample to the next; 0 means 1 */
  int32_t rotation;                  /* degrees clockwise that make it upright: 0, 90, 180, 270 */
  int32_t mirrored;      /* not 0: the upright image is a mirror image of the scene (selfie) */
  int32_t full_range;    /* GRAY8 and YUV: not 0: luma 0..255; 0: video range, luma 16..235 */
  float focal_length_px; /* in pixels of the upright image; 0: not known, use the default FOV */
  float principal_x;     /* principal point in the upright image; both 0: its centre */
  float principal_y;
  int32_t yuv_matrix; /* of YUV: mien_yuv_matrix */
  /* Region of interest: x, y, width, height in pixels of the buffer, before rotation; all 0: the
   * whole. The image counts as cut down to it, and nothing else of it is read; results stay in
   * pixels of the whole upright image, as focal length and principal point do. It may move from
   * image to image while a face is followed. Of YUV, x and y are even. */
  int32_t region[4];
  /* Width of a pixel of the buffer / its height, 0.1..10; 0 means 1. Where it is not 1, the upright
   * image counts as made of square pixels: its height stays, its width follows. Results, focal
   * length and principal point are in those; width, height and region above in the buffer's own. */
  float pixel_aspect;
  uint32_t reserved[2];
} mien_image;

/* Fills in *image: struct_size, full_range = 1, everything else 0. NULL is ignored. */
MIEN_API void mien_image_default(mien_image* image);

/* Sound ---------------------------------------------------------------------------------------- */

#define MIEN_MAX_AUDIO_CHANNELS 8

typedef enum mien_sample_format {
  MIEN_SAMPLES_FLOAT32 = 0, /* full scale is -1..1 */
  MIEN_SAMPLES_INT16 = 1    /* full scale is -32768..32767 */
} mien_sample_format;

/* A block of sound in the caller's memory, which is read during the call only. Start from
 * mien_audio_default. Samples may be anything: what is no number counts as silence, what is beyond
 * full scale as full scale. */
typedef struct mien_audio {
  uint32_t struct_size;
  int32_t format;      /* mien_sample_format */
  int32_t sample_rate; /* 8000..192000 a second */
  int32_t channels;    /* 1..MIEN_MAX_AUDIO_CHANNELS; their mean is heard */
  int32_t planar;      /* not 0: each channel in samples[channel]; 0: interleaved in samples[0] */
  size_t frames;       /* samples of each channel; any number */
  const void* samples[MIEN_MAX_AUDIO_CHANNELS]; /* aligned as the type of the samples is */
  uint32_t reserved[8];
} mien_audio;

/* Fills in *audio: struct_size, sample_rate = 48000, channels = 1, everything else 0. NULL is
 * ignored. */
MIEN_API void mien_audio_default(mien_audio* audio);

/* Tracker -------------------------------------------------------------------------------------- */

typedef struct mien_tracker mien_tracker;

#define MIEN_MAX_FACES 8

/* Callbacks for all the memory of a tracker, called within create and destroy only. */
typedef struct mien_allocator {
  /* At least `size_bytes` aligned to `alignment_bytes` (a power of two), or NULL. */
  void* (*allocate)(void* user, size_t size_bytes, size_t alignment_bytes);
  void (*release)(void* user, void* memory);
  void* user;
} mien_allocator;

/* Start from mien_tracker_config_default; then only the weights have to be set. */
typedef struct mien_tracker_config {
  uint32_t struct_size;
  /* Tiers of kernels that may be used, MIEN_CPU_FUSED; default MIEN_CPU_ALL. For weights that are
   * not the project's, take out MIEN_CPU_HALF unless their encoders' values stay in its range. */
  uint32_t cpu_mask;

  /* Weight files in memory (models/basenet.mien, models/proposal.mien), MIEN_ALIGNMENT-aligned, for
   * instance mapped files or arrays in flash. Owned by the caller; must outlive the tracker and
   * stay as they are. */
  const void* basenet;
  size_t basenet_bytes;
  const void* proposal;
  size_t proposal_bytes;

  mien_allocator allocator; /* default: both callbacks NULL, the C library's allocator */

  /* Monotonic clock in ns, called around the stages of a frame to fill mien_result.stage_ns;
   * default NULL: stages are not timed. */
  uint64_t (*clock_ns)(void* user);
  void* clock_user;

  /* Level of detail, 1 (cheapest) to 4; 0: automatic, by budget_ms. Levels from 2 on need
   * `hifinet`; without it automatic is 1. Default 1. See mien_tracker_set_lod. */
  int32_t lod;
  float horizontal_fov; /* radians, of the upright image, where focal_length_px is 0; 0.01..3.1;
                           default 60 degrees */

  /* Face probability at and above which a searched face is accepted, what the proposal thinks of
   * it taken into account; default 0.999. It has to reach lose_probability without. */
  float accept_probability;
  /* Face probability below which a tracked face counts as missing; default 0.5; must not exceed
   * accept_probability. */
  float lose_probability;
  /* Consecutive judged frames with the face missing until it is lost; 1..1000; default 3. */
  int32_t lose_after_frames;

  /* Face proposal: the longer side of the image is seen at this many pixels, and the smallest
   * face is 12 of them; 24..640; default 160, which finds faces from 7.5 % of the longer side. */
  int32_t proposal_size;
  float proposal_threshold; /* first stage (P-Net), 0..1; default 0.4; a quarter of it in thorough
                               searches (search_interval) */
  float refine_threshold;   /* second stage (R-Net), 0..1; default 0.2 */
  /* Without a face, searches of the whole image follow each other for the first 30 frames; then one
   * begins on every search_interval-th frame at most; 1..1000; default 3. One that begins where the
   * images begin, are cut, or take another size, is done on that image. Another takes its share of
   * several images, 4 to 7 at most levels and 15 to 27 at level 1, so that none costs more than
   * three with a face. Thorough, for faces that are hard to see, are those done on one image, and
   * of the others every second one in a row that finds nothing: they take the most images. */
  int32_t search_interval;

  /* Automatic level of detail: what a followed frame may take on average, ms; 0.01..1e6; default
   * 10. Needs clock_ns; without it the level is the highest that there is. */
  float budget_ms;

  /* Weights of levels 2 to 4 (models/hifinet.mien), under the rules of `basenet`; default NULL:
   * level 1 alone. */
  const void* hifinet;
  size_t hifinet_bytes;

  /* Not 0: controls, landmarks and pose are smoothed where they hardly move, by a 1-euro filter
   * (cutoff 1.5 Hz at rest); a blink passes at 95 % and more, without delay. Default 1. */
  int32_t smoothing;

  /* Faces followed at once, 1..MIEN_MAX_FACES; default 1. Each takes memory of its own. With more
   * than one, newcomers are looked for while a face is followed: in a part of every image, so that
   * all of it was looked at within about a second. */
  int32_t max_faces;

  /* Weights of sound (models/audionet.mien), under the rules of `basenet`; default NULL: the
   * tracker has no ears. MIEN_ERROR_LEFT_OUT in a build without sound (MIEN_WITH_AUDIO). */
  const void* audionet;
  size_t audionet_bytes;
  /* How fast the voice is heard when it begins, and let go when it ends: time constants of
   * mien_result.voice_activity; 0..10000 ms; default 40 and 150. */
  float voice_attack_ms;
  float voice_release_ms;

  /* Room for sound that waits in mien_tracker_queue_audio, in samples of one channel, 0..2^22;
   * default 0: none. Half a second is enough where there are 30 frames a second. */
  int32_t audio_queue_samples;

  /* What the sound says of the controls is multiplied by this before it is mixed with what the
   * picture says, and stays within 0..1; 0..4; default 1: as far as animators open a mouth that
   * speaks clearly. Less mumbles, more suits a stage. */
  float voice_strength;

  uint32_t reserved[6];
} mien_tracker_config;

/* Fills in *config with the defaults; the weights are NULL. NULL is ignored. */
MIEN_API void mien_tracker_config_default(mien_tracker_config* config);

/* Bytes that mien_tracker_create_in needs with this configuration. Validates the configuration and
 * the weight files completely. On error *bytes is 0. */
MIEN_API MIEN_NODISCARD mien_status mien_tracker_required_bytes(const mien_tracker_config* config,
                                                                size_t* bytes);

/* Creates a tracker with one allocation by config->allocator. On success the caller owns *tracker
 * and ends it with mien_tracker_destroy; on error *tracker is NULL and nothing stays allocated.
 * The configuration is copied; the weights are not. */
MIEN_API MIEN_NODISCARD mien_status mien_tracker_create(const mien_tracker_config* config,
                                                        mien_tracker** tracker);

/* The same in the caller's memory, MIEN_ALIGNMENT-aligned, which must outlive the tracker. The
 * allocator is not called. On error *tracker is NULL; the memory's content is unspecified. */
MIEN_API MIEN_NODISCARD mien_status mien_tracker_create_in(const mien_tracker_config* config,
                                                           void* memory, size_t memory_bytes,
                                                           mien_tracker** tracker);

/* Overwrites the tracker's memory with zeros and gives it back to the allocator, or leaves it to
 * the caller after mien_tracker_create_in. NULL is ignored. */
MIEN_API void mien_tracker_destroy(mien_tracker* tracker);

/* Forgets everything seen: from here on every result is, bit for bit, that of a fresh tracker. */
MIEN_API MIEN_NODISCARD mien_status mien_tracker_reset(mien_tracker* tracker);

/* Changes the level of detail from the next image on; 0: automatic. Nothing jumps: between level 1
 * and the others the controls go over within 2 s, among the others at once.
 *
 *   level  controls from  encoders run
 *   4      HiFiNet        both on every frame
 *   3      HiFiNet        BaseNet on every frame, HiFiNet on alternate frames
 *   2      HiFiNet        both on alternate frames
 *   1      BaseNet        BaseNet on alternate frames
 *
 * From level 2 on HiFiNet also refines the landmarks. Automatic goes on from the level before.
 *
 * Whatever the level, controls and head pose move on every frame. MIEN_ERROR_UNSUPPORTED_LOD when
 * there are no weights for it. mien_tracker_reset returns to the level of the configuration. */
MIEN_API MIEN_NODISCARD mien_status mien_tracker_set_lod(mien_tracker* tracker, int32_t lod);

/* Tracks one image. On an error status the frame counts as not pushed and the result stays.
 *
 * pts_ns: time of the image in nanoseconds. Any value is accepted. Expected are images 5 to 120
 * times a second. A repeated timestamp counts as 1/30 s. A step back, or forward by more than 1 s,
 * is taken as a cut: the temporal decoders begin anew, and a face that is not where it was is lost
 * at once.
 *
 * Format, size, rotation and mirroring may change from image to image; when the upright size, the
 * rotation or the mirroring does, the face is searched anew on that image. */
MIEN_API MIEN_NODISCARD mien_status mien_tracker_push_video(mien_tracker* tracker,
                                                            const mien_image* image,
                                                            int64_t pts_ns);

/* One frame of output without an image: for sound alone, and while the camera gives none. `pts_ns`
 * as of mien_tracker_push_video. A face that is followed counts as not seen on it. */
MIEN_API MIEN_NODISCARD mien_status mien_tracker_advance(mien_tracker* tracker, int64_t pts_ns);

/* Hears a block of sound, of one sample or many; the same sound gives the same answers, bit for
 * bit, in blocks of whatever size. A block without samples changes nothing.
 * MIEN_ERROR_NO_AUDIONET without weights for it.
 *
 * pts_ns: time of the block's first sample, on the clock of the images. Between blocks the count of
 * the samples says how time passes, and timestamps that are off by up to 20 ms pull it along, so
 * that two clocks never drift apart. What is off by more is a gap, or sound heard twice: time hops
 * there at once. After more than 0.5 s another stream begins; after a change of the rate, which may
 * come with any block, the same voice goes on.
 *
 * A frame of output takes what is heard at its time: of the middle of 80 ms, so that the sound of a
 * frame is all there 42 ms after it. Until then the last that was heard stands in for it, for
 * 150 ms; then nobody speaks. Sound may be up to 4 s ahead of the pictures.
 *
 * Every control that the sound drives, the mouth's, becomes
 *   (1 - alpha) v + alpha (w_v v + w_a a)
 * of the picture's v and the sound's a, with mien_result.voice_activity as alpha and the weights w
 * of the control. Where the picture says nothing, because no face is there or the level does not
 * drive the control, the sound stands alone: w_a is 1. A face comes and goes within 0.1 s.
 * Of several faces it is the one known longest that speaks. */
MIEN_API MIEN_NODISCARD mien_status mien_tracker_push_audio(mien_tracker* tracker,
                                                            const mien_audio* audio,
                                                            int64_t pts_ns);

/* Leaves a block of sound for the tracker, which hears it with the next frame of output (push_video
 * or advance), as mien_tracker_push_audio would. For the real-time thread of a microphone: it may
 * run while another thread does anything else with the tracker but create and destroy. Wait-free:
 * its time depends on the number of samples alone. MIEN_ERROR_AUDIO_QUEUE_FULL, and nothing is
 * taken, when there is no room (mien_tracker_config.audio_queue_samples): too many samples or
 * blocks wait; a block of half the room always fits once no others do. Whoever queues sound pushes
 * none. */
MIEN_API MIEN_NODISCARD mien_status mien_tracker_queue_audio(mien_tracker* tracker,
                                                             const mien_audio* audio,
                                                             int64_t pts_ns);

/* Of sound pushed from now on: it belongs to images later than its timestamps say, by `offset_ns`,
 * which may be negative. mien_tracker_reset returns to 0. */
MIEN_API MIEN_NODISCARD mien_status mien_tracker_set_audio_offset(mien_tracker* tracker,
                                                                  int64_t offset_ns);

/* The weights w_a and w_v of a control while somebody speaks, each 0..1; the model file has them
 * for all. With w_a = 0 the sound does not drive it. mien_tracker_reset returns to those of the
 * file. MIEN_ERROR_OUT_OF_RANGE also when there is no such control. */
MIEN_API MIEN_NODISCARD mien_status mien_tracker_set_mix(mien_tracker* tracker, int32_t control,
                                                         float audio_weight, float video_weight);

/* Packed weights ------------------------------------------------------------------------------- */

/* A program that carries its weights can carry them packed, without loss, in 70 % of their bytes,
 * if it has memory to unpack them to: scripts/package/pack_weights.py packs a weight file,
 * mien_embed does so when it is told PACKED, docs/format.md says what is in it. */

/* How many bytes they have unpacked goes to *unpacked_bytes: at most 2^31, and at most 820 times
 * packed_bytes. `packed` is aligned in any way. MIEN_ERROR_WEIGHTS_NOT_PACKED;
 * MIEN_ERROR_WEIGHTS_VERSION; MIEN_ERROR_WEIGHTS_TRUNCATED; MIEN_ERROR_WEIGHTS_MALFORMED also when
 * there are more bytes than they say. */
MIEN_API MIEN_NODISCARD mien_status mien_unpacked_bytes(const void* packed, size_t packed_bytes,
                                                        size_t* unpacked_bytes);

/* Unpacks to `file`: the weight file that was packed, byte for byte, as its checksum tells who
 * reads it. Both are the caller's, and `packed` is not needed afterwards. `file` is
 * MIEN_ALIGNMENT-aligned as weight files have to be, does not overlap `packed`, and has
 * mien_unpacked_bytes or more: it is MIEN_ERROR_MEMORY_TOO_SMALL when file_bytes is less, and what
 * is more stays as it is. Errors are those of mien_unpacked_bytes; after
 * MIEN_ERROR_WEIGHTS_MALFORMED `file` may be zeros. */
MIEN_API MIEN_NODISCARD mien_status mien_unpack(const void* packed, size_t packed_bytes, void* file,
                                                size_t file_bytes);

/* Result --------------------------------------------------------------------------------------- */

typedef enum mien_face_status {
  /* No face since create or reset: box, landmarks, pose and controls but those of sound are 0. */
  MIEN_FACE_SEARCHING = 0,
  MIEN_FACE_TRACKING = 1,
  /* The face is gone: box, landmarks and pose keep their last values, the picture's controls fade
   * towards 0 with a time constant of 0.25 s. */
  MIEN_FACE_LOST = 2
} mien_face_status;

/* "searching", "tracking", "lost"; NULL for other numbers. Static. */
MIEN_API const char* mien_face_status_name(int32_t status);

typedef enum mien_stage {
  MIEN_STAGE_PROPOSAL = 0, /* finding a face in the whole image */
  MIEN_STAGE_WARP = 1,     /* image to crop */
  MIEN_STAGE_ENCODER = 2,  /* crop to features */
  MIEN_STAGE_HEADS = 3,    /* features to landmarks and face probability */
  MIEN_STAGE_DECODERS = 4, /* features over time to controls and head pose */
  MIEN_STAGE_SOUND = 5,    /* all mien_tracker_push_audio since the frame before */
  MIEN_STAGE_COUNT = 6
} mien_stage;

/* "proposal", "warp", "encoder", "heads", "decoders", "sound"; NULL for other numbers. Static. */
MIEN_API const char* mien_stage_name(int32_t stage);

/* Bits of mien_result.flags: what happened on this frame. */
#define MIEN_RESULT_PROPOSAL_RAN 0x1u /* a search of the whole image, or a share of one */
/* Not set on the alternate frames of levels 1 and 2: box and landmarks are those of the frame
 * before, but for smoothing, while controls and head pose move on. */
#define MIEN_RESULT_ENCODER_RAN 0x2u
#define MIEN_RESULT_FOUND 0x4u /* a face was (re)found on this frame */
#define MIEN_RESULT_CUT 0x8u   /* the timestamp told of a cut */
/* The frame counts for mien_tracker_capture_neutral. */
#define MIEN_RESULT_CAPTURING_NEUTRAL 0x10u

typedef struct mien_result {
  uint32_t struct_size;
  int32_t status; /* mien_face_status */
  int64_t pts_ns; /* of the image that this result belongs to */
  /* Bit i: control i is driven, at this level of detail, by what fades out of another for up to 2 s
   * (mien_tracker_set_lod) or, once there was sound, by sound. */
  uint64_t supported_controls;

  float face_probability; /* 0..1, of the crop judged last; 0 when there was nothing to judge */
  float voice_activity;   /* 0..1: alpha of mien_tracker_push_audio; 0 without sound */
  int32_t lod;
  uint32_t flags; /* MIEN_RESULT_* */

  float box[4]; /* x, y, width, height in pixels of the upright image; around the whole face */

  float rotation[4];      /* head to camera: unit quaternion x, y, z, w with w >= 0 */
  float pitch, yaw, roll; /* radians; R = Ry(yaw) Rx(pitch) Rz(roll). Positive: looks down; turns
                             to the subject's left; right-hand rule about z */
  float translation[3];   /* metres: the head's origin in camera space */

  float controls[MIEN_CONTROL_COUNT];      /* 0..1; 0 where not supported; of picture and sound */
  float landmarks[MIEN_LANDMARK_COUNT][2]; /* x, y in pixels of the upright image; may lie outside
                                              of it. Order: models/landmarks.json */

  /* Totals since create or reset. */
  uint64_t frames;        /* frames of output: images pushed, and frames without */
  uint64_t face_frames;   /* of these, with a face followed */
  uint64_t proposal_runs; /* searches of the whole image that were begun */
  uint64_t encoder_runs;  /* of BaseNet and HiFiNet */

  uint64_t stage_ns[MIEN_MAX_STAGES]; /* time in each mien_stage on this frame; 0 without a clock */

  /* Counts the faces found, from 1; 0 before any. A face found again near the place where it was
   * lost less than 2 s ago keeps its id. */
  uint32_t face_id;

  uint32_t reserved[15];
} mien_result;

/* Copies the result of the last image pushed into *result, as much as result->struct_size says;
 * before any image: MIEN_FACE_SEARCHING and zeros. Of several faces it is that of the lowest id. */
MIEN_API MIEN_NODISCARD mien_status mien_tracker_get_result(const mien_tracker* tracker,
                                                            mien_result* result);

/* Faces known after the last image, 0..max_faces: those followed, those lost less than 2 s ago, and
 * the last of all, however long it is lost. 0 for NULL. */
MIEN_API int32_t mien_tracker_face_count(const mien_tracker* tracker);

/* The same as mien_tracker_get_result of one of them, in the order of their ids.
 * MIEN_ERROR_OUT_OF_RANGE unless 0 <= index < mien_tracker_face_count. Totals, flags but those of
 * encoders and finding, and times are those of the image. */
MIEN_API MIEN_NODISCARD mien_status mien_tracker_get_face(const mien_tracker* tracker,
                                                          int32_t index, mien_result* result);

/* Fills in *result: struct_size, everything else 0. NULL is ignored. */
MIEN_API void mien_result_default(mien_result* result);

/* Calibration ---------------------------------------------------------------------------------- */

/* Some faces look raised, pressed or half closed while nothing happens. What a face shows when it
 * is neutral can be captured and is then taken out of every control: (control - neutral) /
 * (1 - neutral), not below 0, so that a full blink stays one. For trackers of one face; others
 * answer MIEN_ERROR_SEVERAL_FACES. It stays with the tracker, whoever comes, until
 * mien_tracker_reset. */

/* Captures, at the present level of detail, while the person looks neutral: of each control the
 * median of 45 frames, after 10 to settle, so that a blink does not count; 0.6 at most. Frames that
 * count carry MIEN_RESULT_CAPTURING_NEUTRAL; then it takes effect, in place of an earlier one. It
 * begins anew when the face is lost or the film is cut, and waits where there is none. When the
 * level goes over between 1 and the others it begins anew, at the new one. */
MIEN_API MIEN_NODISCARD mien_status mien_tracker_capture_neutral(mien_tracker* tracker);

#define MIEN_NEUTRAL_BYTES 448

/* What was captured as a file of MIEN_NEUTRAL_BYTES, to be kept; see docs/format.md. Level 1 and
 * the others each have their own: bit 0 of *captured (NULL is fine) says that level 1 has it, bit 1
 * the others. MIEN_ERROR_MEMORY_TOO_SMALL when file_bytes is less. */
MIEN_API MIEN_NODISCARD mien_status mien_tracker_save_neutral(const mien_tracker* tracker,
                                                              void* file, size_t file_bytes,
                                                              uint32_t* captured);

/* Takes over what was saved; levels that were not captured stay as they are. On an error nothing
 * changes. */
MIEN_API MIEN_NODISCARD mien_status mien_tracker_load_neutral(mien_tracker* tracker,
                                                              const void* file, size_t file_bytes);

/* Networks of your own ------------------------------------------------------------------------- */

/* Any network of a weight file, for instance one that scripts/convert/onnx_to_mien.py made. How
 * maps lie in memory, and how networks over time keep their state, is said in mien/engine.h, which
 * has the same for C++, with an example in both. A network may be used by one thread at a time. */
typedef struct mien_network mien_network;

typedef struct mien_shape {
  int32_t height, width, channels;
} mien_shape;

/* Start from mien_network_config_default. */
typedef struct mien_network_config {
  uint32_t struct_size;
  /* Tiers of kernels that may be used; default MIEN_CPU_ALL without MIEN_CPU_HALF, since nobody
   * knows how large the values of a network become. */
  uint32_t cpu_mask;
  /* Weight file in memory, MIEN_ALIGNMENT-aligned. Owned by the caller; must outlive the network
   * and stay as it is. */
  const void* file;
  size_t file_bytes;
  const char* name; /* of the network in the file; default NULL: its first */
  /* Of the input, for networks that take maps of several sizes; default 0, 0: as declared. */
  int32_t height, width;
  mien_allocator allocator; /* default: both callbacks NULL, the C library's allocator */
  uint32_t reserved[8];
} mien_network_config;

/* Fills in *config with the defaults; the file is NULL. NULL is ignored. */
MIEN_API void mien_network_config_default(mien_network_config* config);

/* Makes a network ready to run, with one allocation by config->allocator. On success the caller
 * owns *network and ends it with mien_network_destroy; on error *network is NULL and nothing stays
 * allocated. MIEN_ERROR_WEIGHTS_INCOMPLETE: the file has no network of that name;
 * MIEN_ERROR_WEIGHTS_SHAPE: it does not run on an input of that size. */
MIEN_API MIEN_NODISCARD mien_status mien_network_create(const mien_network_config* config,
                                                        mien_network** network);

/* NULL is ignored. */
MIEN_API void mien_network_destroy(mien_network* network);

/* Where the input is to be written, zeros at first; its shape goes to *shape (NULL is fine). NULL
 * for NULL. */
MIEN_API float* mien_network_input(mien_network* network, mien_shape* shape);

/* One run on the input as it is, one step of a network over time. */
MIEN_API MIEN_NODISCARD mien_status mien_network_run(mien_network* network);

/* 0 for NULL. */
MIEN_API int32_t mien_network_output_count(const mien_network* network);

/* An output of the last run, valid until the next; NULL unless 0 <= index <
 * mien_network_output_count. */
MIEN_API const float* mien_network_output(const mien_network* network, int32_t index,
                                          mien_shape* shape);

/* Puts what a network over time remembers back to a stream's beginning. NULL is ignored. */
MIEN_API void mien_network_reset(mien_network* network);

#ifdef __cplusplus
}
#endif

#endif /* MIEN_MIEN_H_ */
