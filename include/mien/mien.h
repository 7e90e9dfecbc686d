/** @file
 * mien: facial animation from video and audio on a phone's CPU. The public C API.
 *
 * Terms
 *   upright image  The image buffer after rotation clockwise by `rotation`. Pixel (column, row)
 *                  covers [column, column + 1) x [row, row + 1); its centre is at
 *                  (column + 0.5, row + 0.5). A mirrored image stays mirrored, so results can be
 *                  drawn onto it without conversion.
 *   left, right    The subject's left and right.
 *   control        One animation weight, 0..1, with an ARKit name (mien_control_name).
 *   camera space   Right-handed, metres: x right, y up, z towards the viewer; the camera looks
 *                  along -z. It describes the scene itself: the head pose of a mirrored image is
 *                  that of the unmirrored one.
 *   head space     Right-handed, metres: x towards the subject's left, y up, z out of the face;
 *                  the origin lies between the ears.
 *
 * Structs
 *   `struct_size` is the first member of every struct. The caller sets it to sizeof(the struct);
 *   the *_default functions do so. If a caller's struct is shorter than the library's (compiled
 *   with an older header), the library reads or writes only that part and uses defaults for missing
 *   inputs. If it is longer, the library ignores the unknown tail on input and zeroes it on output.
 *   Reserved fields must be zero.
 *
 * Threads
 *   Any thread may call functions without a tracker argument at any time. One thread at a time may
 *   use a tracker or network; a second one may call mien_tracker_queue_audio, and nothing else, at
 *   the same time. Different trackers and networks are independent, also if they share weights. No
 *   function locks, prints, opens files, starts threads, or allocates, except create and destroy,
 *   which call the allocator.
 *
 * Floating point
 *   The caller may use any rounding mode, traps and treatment of denormal numbers: results do not
 *   depend on them, and the library restores them and the sticky flags. Callbacks run in the
 *   library's own mode: round to nearest, no traps, denormal numbers flushed to zero.
 *
 * Stack
 *   Create and required_bytes need up to 96 KiB, all other functions up to 16 KiB.
 *
 * Errors
 *   If a function returns a mien_status other than MIEN_OK, it has no other effect unless its
 *   description says so. MIEN_ERROR_NULL_ARGUMENT: a pointer that must not be NULL is NULL. Status
 *   numbers are never reused. Functions that create an object describe an error further in a
 *   mien_error_detail of the caller: the field, layer or byte, the value and the expected values.
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

#define MIEN_API_VERSION 0x00000100 /**< 0x00XXYYZZ: major, minor, patch */

#define MIEN_CONTROL_COUNT 52   /**< values of mien_control */
#define MIEN_LANDMARK_COUNT 175 /**< points of a face */
#define MIEN_MAX_STAGES 16      /**< size of mien_result.stage_ns; MIEN_STAGE_COUNT are used */

/** Alignment in bytes of the memory of mien_tracker_create_in and mien_network_create_in, and of
 *  weight files that are used without a copy. */
#define MIEN_ALIGNMENT 64

/* Status --------------------------------------------------------------------------------------- */

/** The outcome of a call: MIEN_OK, or a negative number that names the error. */
typedef enum mien_status {
  MIEN_OK = 0,
  /* arguments */
  MIEN_ERROR_NULL_ARGUMENT = -1,    /**< a required pointer is NULL */
  MIEN_ERROR_STRUCT_SIZE = -2,      /**< struct_size does not cover the required fields */
  MIEN_ERROR_OUT_OF_RANGE = -3,     /**< a value is outside its documented range, or NaN */
  MIEN_ERROR_ALIGNMENT = -4,        /**< memory or samples are misaligned */
  MIEN_ERROR_MEMORY_TOO_SMALL = -5, /**< the caller's buffer is too small */
  MIEN_ERROR_OUT_OF_MEMORY = -6,    /**< the allocator returned NULL */
  MIEN_ERROR_UNSUPPORTED_LOD = -7,  /**< level outside 0..4, or no weights for it */
  MIEN_ERROR_SEVERAL_FACES = -8,    /**< only for trackers with max_faces = 1 */
  MIEN_ERROR_NO_AUDIONET = -9,      /**< audio disabled: the tracker has no AudioNet weights */
  /* weight files */
  MIEN_ERROR_WEIGHTS_NOT_MIEN = -20,   /**< not a .mien file, packed or not */
  MIEN_ERROR_WEIGHTS_VERSION = -21,    /**< unsupported version of the file format */
  MIEN_ERROR_WEIGHTS_TRUNCATED = -22,  /**< fewer bytes than the header declares */
  MIEN_ERROR_WEIGHTS_CHECKSUM = -23,   /**< wrong checksum: the file is damaged */
  MIEN_ERROR_WEIGHTS_INCOMPLETE = -25, /**< a required network or constant is missing */
  MIEN_ERROR_WEIGHTS_SHAPE = -26,      /**< a network or constant has the wrong shape */
  MIEN_ERROR_WEIGHTS_VALUE = -27,      /**< a constant has a value out of range */
  /* weight files that break another rule of the format (docs/format.md): -100..-149 */
  MIEN_ERROR_WEIGHTS_TRAILING_BYTES = -100,   /**< bytes after the end of the file */
  MIEN_ERROR_WEIGHTS_BYTE_ORDER = -101,       /**< not little-endian */
  MIEN_ERROR_WEIGHTS_LIMIT = -102,            /**< a count or size exceeds its limit */
  MIEN_ERROR_WEIGHTS_RESERVED = -103,         /**< a reserved field is not zero */
  MIEN_ERROR_WEIGHTS_GAP = -104,              /**< a part does not follow the previous one */
  MIEN_ERROR_WEIGHTS_PADDING = -105,          /**< padding is not zero */
  MIEN_ERROR_WEIGHTS_NAME = -106,             /**< too long, empty, or other than a-z 0-9 _ . / */
  MIEN_ERROR_WEIGHTS_DUPLICATE_NAME = -107,   /**< of a network, constant or metadata key */
  MIEN_ERROR_WEIGHTS_METADATA = -108,         /**< a value is too long or not plain UTF-8 text */
  MIEN_ERROR_WEIGHTS_TENSOR_TYPE = -110,      /**< unknown data type */
  MIEN_ERROR_WEIGHTS_TENSOR_DIMS = -111,      /**< rank or dimensions out of range */
  MIEN_ERROR_WEIGHTS_TENSOR_BYTES = -112,     /**< size does not match dimensions and data type */
  MIEN_ERROR_WEIGHTS_TENSOR_VALUE = -113,     /**< NaN or infinity */
  MIEN_ERROR_WEIGHTS_TENSOR_UNUSED = -114,    /**< neither used by a layer nor named */
  MIEN_ERROR_WEIGHTS_NETWORK = -120,          /**< input, flags, layers or outputs out of range */
  MIEN_ERROR_WEIGHTS_LAYER_OP = -121,         /**< unknown, or not allowed in the network */
  MIEN_ERROR_WEIGHTS_LAYER_ACTIVATION = -122, /**< unknown, or not allowed for the operation */
  MIEN_ERROR_WEIGHTS_LAYER_INPUT = -123,      /**< not an earlier value */
  MIEN_ERROR_WEIGHTS_LAYER_SHAPE = -124,      /**< the output does not match the inputs */
  MIEN_ERROR_WEIGHTS_LAYER_WINDOW = -125,     /**< kernel, stride, padding or flags out of range */
  MIEN_ERROR_WEIGHTS_LAYER_TENSORS = -126,    /**< the tensors do not match the operation */
  MIEN_ERROR_WEIGHTS_PACKED_SIZE = -130,      /**< size of the unpacked file out of range */
  MIEN_ERROR_WEIGHTS_PACKED_BLOCK = -131,     /**< size of a block out of range */
  MIEN_ERROR_WEIGHTS_PACKED_TABLE = -132,     /**< malformed table of a block */
  MIEN_ERROR_WEIGHTS_PACKED_STATE = -133,     /**< wrong state of a decoder: damaged */
  MIEN_ERROR_WEIGHTS_PACKED_TRUNCATED = -134, /**< the last block is incomplete */
  MIEN_ERROR_WEIGHTS_PACKED_TRAILING = -135,  /**< bytes after the last block */
  /* engine */
  MIEN_ERROR_UNSUPPORTED_CPU = -40,    /**< cpu_mask excludes every tier of this CPU and build */
  MIEN_ERROR_UNSUPPORTED_LAYER = -41,  /**< no allowed tier has a kernel for a layer */
  MIEN_ERROR_INTERNAL = -42,           /**< internal error: a defect of mien */
  MIEN_ERROR_LEFT_OUT = -43,           /**< not compiled in */
  MIEN_ERROR_UNSUPPORTED_LAYOUT = -44, /**< a layer other than a convolution reads the image */
  MIEN_ERROR_TOO_LARGE = -45,          /**< the network's maps are too large for this input */
  /* stream */
  MIEN_ERROR_IMAGE_FORMAT = -60,     /**< unknown mien_image_format or mien_yuv_matrix */
  MIEN_ERROR_IMAGE_SIZE = -61,       /**< width, height or pixel_aspect out of range */
  MIEN_ERROR_IMAGE_STRIDE = -62,     /**< rows or chroma samples overlap */
  MIEN_ERROR_IMAGE_PLANE = -63,      /**< a plane of the format is NULL */
  MIEN_ERROR_IMAGE_ROTATION = -64,   /**< rotation is not 0, 90, 180 or 270 degrees */
  MIEN_ERROR_IMAGE_CAMERA = -65,     /**< focal length or principal point negative or not finite */
  MIEN_ERROR_AUDIO_FORMAT = -66,     /**< unknown mien_sample_format */
  MIEN_ERROR_AUDIO_RATE = -67,       /**< sample_rate outside 8000..192000 Hz */
  MIEN_ERROR_AUDIO_CHANNELS = -68,   /**< channels outside 1..MIEN_MAX_AUDIO_CHANNELS */
  MIEN_ERROR_AUDIO_SAMPLES = -69,    /**< a pointer to samples is NULL */
  MIEN_ERROR_IMAGE_REGION = -70,     /**< empty, outside the image, or YUV with odd x or y */
  MIEN_ERROR_AUDIO_QUEUE_FULL = -71, /**< nothing was queued */
  /* neutral files */
  MIEN_ERROR_NEUTRAL_FORMAT = -80,  /**< not a neutral file */
  MIEN_ERROR_NEUTRAL_VERSION = -81, /**< unsupported version of the file format */
  MIEN_ERROR_NEUTRAL_DAMAGED = -82  /**< too long, truncated or modified */
} mien_status;

/** Describes a status in one line of English.
 *  @param status  any number
 *  @return static string, never NULL; "unknown status" for undefined numbers */
MIEN_API const char* mien_status_string(mien_status status);

/** Version of the library.
 *  @return static string "major.minor.patch" */
MIEN_API const char* mien_version(void);

/** API version of the library.
 *  @return MIEN_API_VERSION of the header that the library was built with */
MIEN_API uint32_t mien_version_api(void);

/* Error details -------------------------------------------------------------------------------- */

#define MIEN_MAX_NAME_BYTES 63 /**< bytes of a name in a weight file, without the terminating 0 */

/* Bits of mien_error_detail.known. */
#define MIEN_DETAIL_OFFSET 0x1u   /**< offset */
#define MIEN_DETAIL_GOT 0x2u      /**< got */
#define MIEN_DETAIL_EXPECTED 0x4u /**< expected_min, expected_max */

/** What a function that creates an object found wrong. The caller passes one, or NULL; the function
 *  always fills it, with status MIEN_OK and nothing else on success. Initialize it with
 *  mien_error_detail_default; one that is too small is ignored. */
typedef struct mien_error_detail {
  uint32_t struct_size;
  int32_t status;  /**< mien_status that the function returned */
  uint32_t known;  /**< MIEN_DETAIL_* */
  int32_t file;    /**< index in mien_weights_config.files; -1: none */
  int32_t network; /**< index of the network in its weight file; -1: none */
  int32_t layer;   /**< index of the layer in its network, from 0; -1: none */
  /** Static name of a member of a configuration or of a field in docs/format.md; NULL: none. */
  const char* field;
  uint64_t offset;     /**< byte in the file; of packed content: in the unpacked file */
  double got;          /**< value of the field, in its unit */
  double expected_min; /**< lowest allowed value of the field */
  double expected_max; /**< highest allowed value */
  char name[MIEN_MAX_NAME_BYTES + 1]; /**< of the network or constant; empty: none */
  uint32_t reserved[8];
} mien_error_detail;

/** Initializes a detail: struct_size, no error.
 *  @param[out] detail  NULL is ignored */
MIEN_API void mien_error_detail_default(mien_error_detail* detail);

/** Writes a detail as one line of English: "network encoder, layer 3, byte 832, kernel_height: the
 *  layer's kernel, stride, padding or flags are out of range (got 99, expected 1..15)". Layers
 *  count from 1, as in `mien info`. The index of the file is left to the caller, who may know its
 *  path.
 *  @param[in]  detail      detail
 *  @param[out] text        [text_bytes], always terminated; truncated if it is too small
 *  @param      text_bytes  size of `text`; 256 bytes are always enough
 *  @return length of the whole line in bytes, without the terminating 0; 0 for NULL */
MIEN_API size_t mien_error_message(const mien_error_detail* detail, char* text, size_t text_bytes);

/* CPU ------------------------------------------------------------------------------------------ */

/* One bit per tier (the kernels for one set of CPU instructions). The numbers are fixed; a build
 * contains only some of the tiers. */
#define MIEN_CPU_REF 0x01u /**< readable scalar code, slow */
#define MIEN_CPU_AVX2 0x02u
#define MIEN_CPU_AVX512 0x04u
#define MIEN_CPU_NEON 0x08u
#define MIEN_CPU_NEON_FP16 0x10u
#define MIEN_CPU_NEON32 0x20u
#define MIEN_CPU_WASM 0x40u
#define MIEN_CPU_AVX512_FP16 0x80u
#define MIEN_CPU_AVX512_VNNI 0x100u
#define MIEN_CPU_AVX2_INT16 0x200u
#define MIEN_CPU_AVX_VNNI 0x400u
#define MIEN_CPU_WASM_INT16 0x800u
#define MIEN_CPU_NEON_DOT 0x1000u
#define MIEN_CPU_NEON_I8MM 0x2000u
/** All tiers that compute with 16 bits where that is faster. Results have about three digits. Half
 *  precision is correct only for networks whose values stay within 65504, as those of the project's
 *  networks do. */
#define MIEN_CPU_HALF                                                                       \
  (MIEN_CPU_NEON_FP16 | MIEN_CPU_AVX512_FP16 | MIEN_CPU_AVX512_VNNI | MIEN_CPU_AVX2_INT16 | \
   MIEN_CPU_AVX_VNNI | MIEN_CPU_WASM_INT16 | MIEN_CPU_NEON_DOT | MIEN_CPU_NEON_I8MM)
/** Not a tier: allows fused layers, which are faster. Without it each layer runs separately, with
 *  the same results except for rounding. */
#define MIEN_CPU_FUSED 0x80000000u
#define MIEN_CPU_ALL 0xFFFFFFFFu /**< all tiers and MIEN_CPU_FUSED */

/** Tiers that this build contains and this CPU can run.
 *  @return MIEN_CPU_* bits; always with MIEN_CPU_REF, unless the build excludes it (MIEN_TRIM_REF)
 */
MIEN_API uint32_t mien_cpu_tiers(void);

/** Name of a tier.
 *  @param tier  one MIEN_CPU_* bit
 *  @return static string ("ref", "avx2", ...); NULL for other numbers */
MIEN_API const char* mien_cpu_tier_name(uint32_t tier);

/** Runs fused multiply-adds in registers only: the peak of a tier, with which benchmarks compare.
 *  @param cpu_mask  MIEN_CPU_* bits; the best tier of them that this CPU can run
 *  @param rounds    1 or more; 100000 take some tenths of a millisecond to a few milliseconds
 *  @return number of multiply-adds; 0 if there is no such tier */
MIEN_API int64_t mien_cpu_multiply_adds(uint32_t cpu_mask, int64_t rounds);

/* Names ---------------------------------------------------------------------------------------- */

/** Controls: indices into mien_result.controls, and bits of mien_result.supported_controls. ARKit's
 *  blendshapes in the order of Apple's Live Link wire format; left and right are the subject's. */
typedef enum mien_control {
  MIEN_CONTROL_EYE_BLINK_LEFT = 0,
  MIEN_CONTROL_EYE_LOOK_DOWN_LEFT = 1,
  MIEN_CONTROL_EYE_LOOK_IN_LEFT = 2,
  MIEN_CONTROL_EYE_LOOK_OUT_LEFT = 3,
  MIEN_CONTROL_EYE_LOOK_UP_LEFT = 4,
  MIEN_CONTROL_EYE_SQUINT_LEFT = 5,
  MIEN_CONTROL_EYE_WIDE_LEFT = 6,
  MIEN_CONTROL_EYE_BLINK_RIGHT = 7,
  MIEN_CONTROL_EYE_LOOK_DOWN_RIGHT = 8,
  MIEN_CONTROL_EYE_LOOK_IN_RIGHT = 9,
  MIEN_CONTROL_EYE_LOOK_OUT_RIGHT = 10,
  MIEN_CONTROL_EYE_LOOK_UP_RIGHT = 11,
  MIEN_CONTROL_EYE_SQUINT_RIGHT = 12,
  MIEN_CONTROL_EYE_WIDE_RIGHT = 13,
  MIEN_CONTROL_JAW_FORWARD = 14,
  MIEN_CONTROL_JAW_LEFT = 15,
  MIEN_CONTROL_JAW_RIGHT = 16,
  MIEN_CONTROL_JAW_OPEN = 17,
  MIEN_CONTROL_MOUTH_CLOSE = 18,
  MIEN_CONTROL_MOUTH_FUNNEL = 19,
  MIEN_CONTROL_MOUTH_PUCKER = 20,
  MIEN_CONTROL_MOUTH_LEFT = 21,
  MIEN_CONTROL_MOUTH_RIGHT = 22,
  MIEN_CONTROL_MOUTH_SMILE_LEFT = 23,
  MIEN_CONTROL_MOUTH_SMILE_RIGHT = 24,
  MIEN_CONTROL_MOUTH_FROWN_LEFT = 25,
  MIEN_CONTROL_MOUTH_FROWN_RIGHT = 26,
  MIEN_CONTROL_MOUTH_DIMPLE_LEFT = 27,
  MIEN_CONTROL_MOUTH_DIMPLE_RIGHT = 28,
  MIEN_CONTROL_MOUTH_STRETCH_LEFT = 29,
  MIEN_CONTROL_MOUTH_STRETCH_RIGHT = 30,
  MIEN_CONTROL_MOUTH_ROLL_LOWER = 31,
  MIEN_CONTROL_MOUTH_ROLL_UPPER = 32,
  MIEN_CONTROL_MOUTH_SHRUG_LOWER = 33,
  MIEN_CONTROL_MOUTH_SHRUG_UPPER = 34,
  MIEN_CONTROL_MOUTH_PRESS_LEFT = 35,
  MIEN_CONTROL_MOUTH_PRESS_RIGHT = 36,
  MIEN_CONTROL_MOUTH_LOWER_DOWN_LEFT = 37,
  MIEN_CONTROL_MOUTH_LOWER_DOWN_RIGHT = 38,
  MIEN_CONTROL_MOUTH_UPPER_UP_LEFT = 39,
  MIEN_CONTROL_MOUTH_UPPER_UP_RIGHT = 40,
  MIEN_CONTROL_BROW_DOWN_LEFT = 41,
  MIEN_CONTROL_BROW_DOWN_RIGHT = 42,
  MIEN_CONTROL_BROW_INNER_UP = 43,
  MIEN_CONTROL_BROW_OUTER_UP_LEFT = 44,
  MIEN_CONTROL_BROW_OUTER_UP_RIGHT = 45,
  MIEN_CONTROL_CHEEK_PUFF = 46,
  MIEN_CONTROL_CHEEK_SQUINT_LEFT = 47,
  MIEN_CONTROL_CHEEK_SQUINT_RIGHT = 48,
  MIEN_CONTROL_NOSE_SNEER_LEFT = 49,
  MIEN_CONTROL_NOSE_SNEER_RIGHT = 50,
  MIEN_CONTROL_TONGUE_OUT = 51
} mien_control;

/** ARKit name of a control, in lowerCamelCase.
 *  @param control  mien_control
 *  @return static string ("eyeBlinkLeft" .. "tongueOut"); NULL outside the range */
MIEN_API const char* mien_control_name(int32_t control);

/** Names of facial controls in other blendshape standards. */
typedef enum mien_vocabulary {
  /** 52: the controls unchanged */
  MIEN_VOCABULARY_ARKIT = 0,
  /** 52: _neutral (always 0), then 51 alphabetically; no tongueOut */
  MIEN_VOCABULARY_MEDIAPIPE = 1,
  /** 50: FACS of Roblox's FaceControls, in the order of its enum */
  MIEN_VOCABULARY_ROBLOX = 2,
  /** 11: Joy Angry Sorrow Fun A I U E O Blink_L Blink_R */
  MIEN_VOCABULARY_VRM0 = 3,
  /** 11: happy angry sad relaxed aa ih ou ee oh blinkLeft blinkRight */
  MIEN_VOCABULARY_VRM1 = 4,
  /** 15 of OVR LipSync: sil PP FF TH DD kk CH SS nn RR aa E ih oh ou */
  MIEN_VOCABULARY_VISEMES = 5
} mien_vocabulary;

/** Number of names in a vocabulary.
 *  @param vocabulary  mien_vocabulary
 *  @return 11..52; 0 for undefined numbers */
MIEN_API int32_t mien_vocabulary_size(int32_t vocabulary);

/** A name of a vocabulary, spelled as its standard spells it.
 *  @param vocabulary  mien_vocabulary
 *  @param index       0..mien_vocabulary_size - 1
 *  @return static string; NULL outside the range */
MIEN_API const char* mien_vocabulary_name(int32_t vocabulary, int32_t index);

/** Converts controls to another vocabulary.
 *
 *  A name without left and right gets the mean of both sides; vocabulary_tables.h has all rules.
 *  The conversion is exact for MediaPipe and nearly exact for Roblox; vowels and emotions of VRM
 *  are approximations. Visemes are the mixture of mouth poses that is closest to the mouth
 *  (formats/vocabulary/visemes.h), as in `mien track --format visemes`; their sum is 1. Names
 *  without a corresponding control (FlatPucker, TongueUp, TongueDown, Fun, relaxed) are 0.
 *
 *  @param      vocabulary  mien_vocabulary
 *  @param[in]  controls    [MIEN_CONTROL_COUNT], 0..1
 *  @param[out] values      [count], 0..1
 *  @param      count       mien_vocabulary_size(vocabulary)
 *  @return MIEN_OK; MIEN_ERROR_NULL_ARGUMENT; MIEN_ERROR_OUT_OF_RANGE for an undefined vocabulary
 *          or a wrong count */
MIEN_API MIEN_NODISCARD mien_status mien_vocabulary_values(int32_t vocabulary,
                                                           const float* controls, float* values,
                                                           int32_t count);

/** Names of a vocabulary that the supported controls determine.
 *  @param vocabulary          mien_vocabulary
 *  @param supported_controls  mien_result.supported_controls: bit i stands for control i
 *  @return bit i: name i is supported; a viseme is if the control that its pose moves most is */
MIEN_API uint64_t mien_vocabulary_supported(int32_t vocabulary, uint64_t supported_controls);

/** Finds the values that move an avatar's morph targets, by their names.
 *
 *  Names of ARKit, Roblox, visemes and VRM are found, also as Ready Player Me, VRChat and VRoid
 *  spell them: letters and digits after the last dot, colon or bar count, in upper or lower case,
 *  and _L and _R at the end mean left and right. A prefix before an underscore, as in
 *  Head_jawOpen, is skipped if at least 3 different names follow it. Visemes and names of VRM are
 *  only used if no target opens the jaw by a name of ARKit or Roblox, and if the targets have at
 *  least 3 of them: those of the vocabulary that has most.
 *
 *  @param[in]  names         [count], UTF-8: of all morph targets of the avatar
 *  @param      count         number of names, 0 or more
 *  @param[out] vocabularies  [count], mien_vocabulary; -1: nothing moves the target
 *  @param[out] indices       [count], of a value of mien_vocabulary_values; -1 as above
 *  @return MIEN_OK; MIEN_ERROR_NULL_ARGUMENT, also for a name; MIEN_ERROR_OUT_OF_RANGE for a
 *          negative count */
MIEN_API MIEN_NODISCARD mien_status mien_vocabulary_match(const char* const* names, int32_t count,
                                                          int32_t* vocabularies, int32_t* indices);

/** Number of controls of the library. @return MIEN_CONTROL_COUNT at its build time */
MIEN_API int32_t mien_control_count(void);
/** Number of landmarks of the library. @return MIEN_LANDMARK_COUNT at its build time */
MIEN_API int32_t mien_landmark_count(void);

/** Groups of landmarks. Each is a range of indices into mien_result.landmarks, in the order of
 *  models/landmarks.json; together they are all landmarks. Left and right are the subject's. */
typedef enum mien_landmark_group {
  /** 9: outer to inner corner along the lower lid, with both corners */
  MIEN_LANDMARKS_RIGHT_EYE_LOWER = 0,
  MIEN_LANDMARKS_LEFT_EYE_LOWER = 1,   /**< 9 */
  MIEN_LANDMARKS_RIGHT_EYE_UPPER = 2,  /**< 7: the upper lid between the corners, outer to inner */
  MIEN_LANDMARKS_LEFT_EYE_UPPER = 3,   /**< 7 */
  MIEN_LANDMARKS_RIGHT_IRIS = 4,       /**< 5: centre, nasal, top, temporal, bottom */
  MIEN_LANDMARKS_LEFT_IRIS = 5,        /**< 5 */
  MIEN_LANDMARKS_RIGHT_BROW_UPPER = 6, /**< 5: upper edge, outer to inner */
  MIEN_LANDMARKS_LEFT_BROW_UPPER = 7,  /**< 5 */
  MIEN_LANDMARKS_RIGHT_BROW_LOWER = 8, /**< 5: lower edge, outer to inner */
  MIEN_LANDMARKS_LEFT_BROW_LOWER = 9,  /**< 5 */
  MIEN_LANDMARKS_RIGHT_NOSE_SIDE = 10, /**< 8: nostril and side of the nose */
  MIEN_LANDMARKS_LEFT_NOSE_SIDE = 11,  /**< 8 */
  MIEN_LANDMARKS_RIGHT_CHEEK = 12,     /**< 5 */
  MIEN_LANDMARKS_LEFT_CHEEK = 13,      /**< 5 */
  MIEN_LANDMARKS_NOSE_BRIDGE = 14,     /**< 8: from between the eyes to below the tip */
  MIEN_LANDMARKS_MIDLINE = 15,         /**< 3: forehead, between the brows, chin */
  /** 11: right to left corner along the upper edge, with both corners */
  MIEN_LANDMARKS_LIPS_OUTER_UPPER = 16,
  /** 9: right to left along the lower edge, without the corners */
  MIEN_LANDMARKS_LIPS_OUTER_LOWER = 17,
  MIEN_LANDMARKS_LIPS_INNER_UPPER = 18, /**< 11: the same for the inner edge of the upper lip */
  MIEN_LANDMARKS_LIPS_INNER_LOWER = 19, /**< 9: the same for the inner edge of the lower lip */
  /** 36: from the top of the forehead over the left side and round the chin; 6..30 are the jaw line
   */
  MIEN_LANDMARKS_FACE_OVAL = 20
} mien_landmark_group;

#define MIEN_LANDMARK_GROUP_COUNT 21

/** Name of a group of landmarks.
 *  @param group  mien_landmark_group
 *  @return static string ("right_eye_lower" .. "face_oval"); NULL outside the range */
MIEN_API const char* mien_landmark_group_name(int32_t group);

/** Landmarks of a group.
 *  @param      group  mien_landmark_group
 *  @param[out] first  index of the group's first landmark; 0 outside the range; may be NULL
 *  @return number of landmarks in the group; 0 outside the range */
MIEN_API int32_t mien_landmark_group_range(int32_t group, int32_t* first);

/* Image ---------------------------------------------------------------------------------------- */

#define MIEN_MAX_IMAGE_SIDE 16384 /**< pixels */

/** Pixel formats. YUV is BT.601 unless mien_image.yuv_matrix selects BT.709, with chroma subsampled
 *  2 x 2: a chroma plane has (height + 1) / 2 rows of (width + 1) / 2 samples. For YV12 use I420
 *  and swap planes 1 and 2. For Android's YUV_420_888 use I420 and set chroma_pixel_stride_bytes to
 *  the plane's pixel stride. */
typedef enum mien_image_format {
  MIEN_IMAGE_GRAY8 = 0, /**< 1 plane */
  MIEN_IMAGE_RGB = 1,   /**< 1 plane, 3 bytes per pixel */
  MIEN_IMAGE_BGR = 2,   /**< 1 plane, 3 bytes per pixel */
  MIEN_IMAGE_RGBA = 3,  /**< 1 plane, 4 bytes per pixel; ignores the fourth, so also RGBX */
  MIEN_IMAGE_BGRA = 4,  /**< 1 plane, 4 bytes per pixel; ignores the fourth, so also BGRX */
  MIEN_IMAGE_NV12 = 5,  /**< 2 planes: Y; U and V interleaved */
  MIEN_IMAGE_NV21 = 6,  /**< 2 planes: Y; V and U interleaved */
  MIEN_IMAGE_I420 = 7   /**< 3 planes: Y; U; V */
} mien_image_format;

/** Conversion between RGB and YUV: BT.601 in cameras and SD video, BT.709 in most HD video. */
typedef enum mien_yuv_matrix { MIEN_YUV_BT601 = 0, MIEN_YUV_BT709 = 1 } mien_yuv_matrix;

/** An image in the caller's memory. The library reads it only during the call, and never reads
 *  bytes after the last pixel of a row. Initialize it with mien_image_default. */
typedef struct mien_image {
  uint32_t struct_size;
  int32_t format;        /**< mien_image_format */
  int32_t width;         /**< pixels of the buffer, before rotation; 1..MIEN_MAX_IMAGE_SIDE */
  int32_t height;        /**< pixels of the buffer, before rotation; 1..MIEN_MAX_IMAGE_SIDE */
  const void* planes[3]; /**< first byte of the top row; unused planes are ignored */
  /** Bytes from the start of a row to that of the row below; negative for bottom-up memory. */
  int32_t row_stride_bytes[3];
  int32_t chroma_pixel_stride_bytes; /**< I420: bytes from a chroma sample to the next; 0 means 1 */
  int32_t rotation;                  /**< clockwise rotation to upright: 0, 90, 180, 270 degrees */
  int32_t mirrored;      /**< not 0: the upright image mirrors the scene (selfie camera) */
  int32_t full_range;    /**< GRAY8 and YUV; not 0: luma 0..255; 0: video range, luma 16..235 */
  float focal_length_px; /**< pixels of the upright image; 0: unknown, horizontal_fov applies */
  float principal_x;     /**< principal point, pixels of the upright image; x = y = 0: the centre */
  float principal_y;     /**< likewise, from the top */
  int32_t yuv_matrix;    /**< YUV: mien_yuv_matrix */
  /** Region of interest: x, y, width, height in pixels of the buffer, before rotation; all 0: the
   *  whole image. The tracker reads nothing outside it and behaves as if the image were cropped to
   *  it, but results, focal length and principal point stay in pixels of the whole upright image.
   *  The region may move from image to image during tracking. For YUV, x and y must be even. */
  int32_t region[4];
  /** Width / height of a pixel of the buffer, 0.1..10; 0 means 1. If it is not 1, the upright image
   *  is rescaled to square pixels: its height stays, its width changes. Results, focal length and
   *  principal point use these square pixels; width, height and region use those of the buffer. */
  float pixel_aspect;
  uint32_t reserved[2];
} mien_image;

/** Initializes an image: struct_size, full_range = 1, all other fields 0.
 *  @param[out] image  NULL is ignored */
MIEN_API void mien_image_default(mien_image* image);

/* Audio ---------------------------------------------------------------------------------------- */

#define MIEN_MAX_AUDIO_CHANNELS 8

/** Types of audio samples, in the byte order of the machine. */
typedef enum mien_sample_format {
  MIEN_SAMPLES_FLOAT32 = 0, /**< full scale is -1..1 */
  MIEN_SAMPLES_INT16 = 1    /**< full scale is -32768..32767 */
} mien_sample_format;

/** An audio block in the caller's memory. The library reads it only during the call. Initialize it
 *  with mien_audio_default. Samples may have any value: NaN and infinity count as silence, others
 *  are clamped to full scale. */
typedef struct mien_audio {
  uint32_t struct_size;
  int32_t format;      /**< mien_sample_format */
  int32_t sample_rate; /**< 8000..192000 Hz */
  int32_t channels;    /**< 1..MIEN_MAX_AUDIO_CHANNELS; the tracker uses their mean */
  int32_t planar; /**< not 0: channel i in samples[i]; 0: all channels interleaved in samples[0] */
  size_t frames;  /**< samples per channel; any number */
  const void* samples[MIEN_MAX_AUDIO_CHANNELS]; /**< aligned to the type of the samples */
  uint32_t reserved[8];
} mien_audio;

/** Initializes an audio block: struct_size, sample_rate = 48000, channels = 1, all other fields 0.
 *  @param[out] audio  NULL is ignored */
MIEN_API void mien_audio_default(mien_audio* audio);

/* Weights -------------------------------------------------------------------------------------- */

/** Callbacks for all memory of weights, trackers and networks; only create and destroy call them.
 */
typedef struct mien_allocator {
  /** Returns at least `size_bytes` aligned to `alignment_bytes` (a power of two), or NULL. */
  void* (*allocate)(void* user, size_t size_bytes, size_t alignment_bytes);
  /** Releases memory of `allocate`; never NULL. */
  void (*release)(void* user, void* memory);
  void* user; /**< first argument of both */
} mien_allocator;

/** Opened and validated weight files. Any number of trackers and networks in any threads may share
 *  them: each keeps a reference to the weights that it uses. */
typedef struct mien_weights mien_weights;

#define MIEN_MAX_WEIGHT_FILES 8

/** Weight files in memory. Initialize it with mien_weights_config_default.
 *
 *  A file is one .mien file, a packed one (scripts/package/pack_weights.py), or a bundle: several
 *  of these one after another, as `cat` joins them. The order does not matter: a tracker finds
 *  BaseNet, the detector, HiFiNet and AudioNet by their networks. There may be 16 .mien files in
 *  total. */
typedef struct mien_weights_config {
  uint32_t struct_size;
  /** Not 0: files are copied, so that their memory is free after mien_weights_create. 0 (default):
   *  a .mien file that begins at a multiple of MIEN_ALIGNMENT is used in place, and must stay
   *  unchanged until the weights and everything created from them are destroyed; others are copied
   *  or unpacked. */
  int32_t copy;
  const void* files[MIEN_MAX_WEIGHT_FILES]; /**< any alignment; NULL entries are ignored */
  size_t file_bytes[MIEN_MAX_WEIGHT_FILES]; /**< sizes of `files`, bytes */
  mien_allocator allocator; /**< default: both callbacks NULL, which selects the C library's */
  uint32_t reserved[8];
} mien_weights_config;

/** Initializes a configuration with the defaults, without files.
 *  @param[out] config  NULL is ignored */
MIEN_API void mien_weights_config_default(mien_weights_config* config);

/** Opens weight files: copies them as far as necessary, and validates them completely, with one
 *  allocation by config->allocator.
 *  @param[in]  config   configuration
 *  @param[out] weights  owned by the caller, who ends it with mien_weights_destroy; NULL on error,
 *                       when nothing stays allocated
 *  @param[out] error    describes the error; may be NULL
 *  @return MIEN_OK; MIEN_ERROR_NULL_ARGUMENT (also without files); MIEN_ERROR_STRUCT_SIZE;
 *          MIEN_ERROR_OUT_OF_RANGE (one callback of two); MIEN_ERROR_OUT_OF_MEMORY; a
 *          MIEN_ERROR_WEIGHTS_* status, of these MIEN_ERROR_WEIGHTS_LIMIT for too many files */
MIEN_API MIEN_NODISCARD mien_status mien_weights_create(const mien_weights_config* config,
                                                        mien_weights** weights,
                                                        mien_error_detail* error);

/** Ends the caller's ownership. The memory is released as soon as no tracker or network uses the
 *  weights.
 *  @param weights  NULL is ignored */
MIEN_API void mien_weights_destroy(mien_weights* weights);

/* Tracker -------------------------------------------------------------------------------------- */

/** A tracker: converts images and audio to the animation of one or more faces. */
typedef struct mien_tracker mien_tracker;

#define MIEN_MAX_FACES 8

/** Configuration of a tracker. Initialize it with mien_tracker_config_default; only `weights` has
 *  no default. */
typedef struct mien_tracker_config {
  uint32_t struct_size;
  /** Allowed tiers, and MIEN_CPU_FUSED; default MIEN_CPU_ALL. For other weights than the project's,
   *  exclude MIEN_CPU_HALF unless the values of their encoders stay within its range. */
  uint32_t cpu_mask;

  /** Weights with BaseNet and the detector (models/basenet.mien, models/proposal.mien), and HiFiNet
   *  and AudioNet if there are (models/hifinet.mien, models/audionet.mien). */
  const mien_weights* weights;

  mien_allocator allocator; /**< default: both callbacks NULL, which selects the C library's */

  /** Monotonic clock in ns for mien_result.stage_ns and for the automatic level of detail; default
   *  NULL: stages are not timed. */
  uint64_t (*clock_ns)(void* user);
  void* clock_user; /**< argument of clock_ns */

  /** Level of detail: 1 (fastest) to 4 (most accurate), or 0 for automatic by budget_ms; default 1.
   *  Levels 2 to 4 need HiFiNet; without it automatic means 1. See mien_tracker_set_lod. */
  int32_t lod;
  /** Highest level of detail that the tracker will use, 1..4; default 4. 1 leaves HiFiNet out and
   *  saves its memory. */
  int32_t max_lod;
  /** Horizontal field of view of the upright image for images with focal_length_px = 0, in radians;
   *  0.01..3.1; default pi / 3 (60 degrees). */
  float horizontal_fov;

  /** Minimum face probability, combined with the detector score, of a detection that becomes a
   *  tracked face; 0..1; default 0.999. The face probability alone must reach lose_probability. */
  float accept_probability;
  /** A tracked face below this face probability counts as missed; 0..accept_probability; default
   *  0.5. */
  float lose_probability;
  /** Consecutive misses after which a face is lost; 1..1000; default 3. */
  int32_t lose_after_frames;

  /** Pixels to which detection scales the longer side of the image; 24..640; default 160. The
   *  smallest detectable face is 12 of these pixels: by default 7.5 % of the longer side. */
  int32_t proposal_size;
  /** Threshold of the first detection stage (P-Net), 0..1; default 0.4. Thorough detection
   *  (search_interval) uses a quarter of it. */
  float proposal_threshold;
  float refine_threshold; /**< threshold of the second stage (R-Net), 0..1; default 0.2 */
  /** Frames between detections in the whole image while there is no face; 1..1000; default 3. In
   *  the first 30 frames without a face one detection follows the other without a pause.
   *
   *  A detection runs on a single image if that is the first one, follows a discontinuity, or has a
   *  new size. Otherwise its work is spread over several images (6 to 13; 22 to 50 at level 1),
   *  and large faces are detected in between, at another roll on every image (every second one at
   *  level 1). An image without a face then costs about as much as two images with one, four at
   *  level 1. Thorough detection finds faces that are hard to see and takes the most images: it
   *  applies to detections on a single image, and to every fourth one of the others in a row
   *  without success. Half of these others search for faces at a roll other than 0. */
  int32_t search_interval;

  /** Automatic level of detail: average time budget of a frame with a face, in ms; 0.01..1e6;
   *  default 10. Needs clock_ns; without it the highest available level is used. */
  float budget_ms;

  /** Not 0: a 1-euro filter smooths controls, landmarks and pose while they hardly move (cutoff
   *  1.5 Hz at rest). A blink keeps at least 95 % of its height and is not delayed. Default 1. */
  int32_t smoothing;

  /** Maximum number of faces tracked at the same time, 1..MIEN_MAX_FACES; default 1. Each uses
   *  additional memory. If it is above 1, the tracker also looks for new faces while it tracks
   *  others, in one part of every image, and covers the whole image within about a second. */
  int32_t max_faces;

  /** Not 0 (default): the tracker accepts audio if the weights have AudioNet; MIEN_ERROR_LEFT_OUT
   *  if they do and audio is not compiled in (MIEN_WITH_AUDIO). 0: audio disabled. */
  int32_t audio;
  /** Attack and release: time constants with which mien_result.voice_activity rises and falls, in
   *  ms; 0..10000; default 40 and 150. */
  float voice_attack_ms;
  float voice_release_ms;

  /** Capacity of the queue of mien_tracker_queue_audio, in samples of one channel; 0..2^22; default
   *  0: no queue. Half a second is enough at 30 frames per second. */
  int32_t audio_queue_samples;

  /** Factor of the controls predicted from audio before mixing; the products are clamped to 0..1.
   *  0..4; default 1, the opening of the mouth that animators give to clear speech. Lower values
   *  resemble mumbling, higher ones suit a stage. */
  float voice_strength;

  uint32_t reserved[8];
} mien_tracker_config;

/** Initializes a configuration with the defaults; the weights are NULL.
 *  @param[out] config  NULL is ignored */
MIEN_API void mien_tracker_config_default(mien_tracker_config* config);

/** Computes the size of the memory for mien_tracker_create_in, and validates the configuration
 *  completely.
 *  @param[in]  config  configuration
 *  @param[out] bytes   size in bytes; 0 on error
 *  @param[out] error   describes the error; may be NULL
 *  @return a status of mien_tracker_create other than MIEN_ERROR_OUT_OF_MEMORY */
MIEN_API MIEN_NODISCARD mien_status mien_tracker_required_bytes(const mien_tracker_config* config,
                                                                size_t* bytes,
                                                                mien_error_detail* error);

/** Creates a tracker with one allocation by config->allocator. Copies the configuration, and refers
 *  to the weights.
 *  @param[in]  config   configuration
 *  @param[out] tracker  owned by the caller, who ends it with mien_tracker_destroy; NULL on error,
 *                       when nothing stays allocated
 *  @param[out] error    describes the error; may be NULL
 *  @return MIEN_OK; MIEN_ERROR_NULL_ARGUMENT (also for missing weights); MIEN_ERROR_STRUCT_SIZE;
 *          MIEN_ERROR_OUT_OF_RANGE; MIEN_ERROR_UNSUPPORTED_LOD; MIEN_ERROR_OUT_OF_MEMORY;
 *          MIEN_ERROR_WEIGHTS_INCOMPLETE; MIEN_ERROR_WEIGHTS_SHAPE; MIEN_ERROR_WEIGHTS_VALUE;
 *          MIEN_ERROR_UNSUPPORTED_CPU; MIEN_ERROR_UNSUPPORTED_LAYER; MIEN_ERROR_UNSUPPORTED_LAYOUT;
 *          MIEN_ERROR_TOO_LARGE; MIEN_ERROR_LEFT_OUT; MIEN_ERROR_INTERNAL */
MIEN_API MIEN_NODISCARD mien_status mien_tracker_create(const mien_tracker_config* config,
                                                        mien_tracker** tracker,
                                                        mien_error_detail* error);

/** Creates a tracker in memory of the caller, without calling the allocator.
 *  @param[in]  config        configuration
 *  @param      memory        [memory_bytes], MIEN_ALIGNMENT-aligned; must outlive the tracker; its
 *                            content is unspecified after an error
 *  @param      memory_bytes  at least mien_tracker_required_bytes
 *  @param[out] tracker       NULL on error
 *  @param[out] error         describes the error; may be NULL
 *  @return as mien_tracker_create; MIEN_ERROR_MEMORY_TOO_SMALL; MIEN_ERROR_ALIGNMENT */
MIEN_API MIEN_NODISCARD mien_status mien_tracker_create_in(const mien_tracker_config* config,
                                                           void* memory, size_t memory_bytes,
                                                           mien_tracker** tracker,
                                                           mien_error_detail* error);

/** Overwrites the tracker's memory with zeros and releases it with the allocator; after
 *  mien_tracker_create_in the memory stays with the caller.
 *  @param tracker  NULL is ignored */
MIEN_API void mien_tracker_destroy(mien_tracker* tracker);

/** Resets a tracker to its state after creation: all later results are bit-identical to those of a
 *  new tracker.
 *  @param tracker  tracker
 *  @return MIEN_OK; MIEN_ERROR_NULL_ARGUMENT */
MIEN_API MIEN_NODISCARD mien_status mien_tracker_reset(mien_tracker* tracker);

/** Sets the level of detail from the next image on. mien_tracker_reset restores the configured one.
 *
 *      level  controls from  encoders
 *      4      HiFiNet        both on every frame
 *      3      HiFiNet        BaseNet on every frame, HiFiNet on alternate frames
 *      2      HiFiNet        both on alternate frames
 *      1      BaseNet        BaseNet on alternate frames
 *      0      automatic: the highest level within budget_ms, starting at the previous level
 *
 *  From level 2 on, HiFiNet also refines the landmarks. Controls and head pose change on every
 *  frame at every level. Changes between level 1 and the others crossfade within 2 s; changes among
 *  the others take effect at once.
 *
 *  @param tracker  tracker
 *  @param lod      0..4
 *  @return MIEN_OK; MIEN_ERROR_NULL_ARGUMENT; MIEN_ERROR_UNSUPPORTED_LOD outside 0..4 or without
 *          weights for the level */
MIEN_API MIEN_NODISCARD mien_status mien_tracker_set_lod(mien_tracker* tracker, int32_t lod);

/** Tracks one image. After an error the tracker and its result are unchanged.
 *
 *  Format, size, rotation and mirroring may change from image to image. A change of the upright
 *  size, rotation or mirroring starts a new detection on that image.
 *
 *  @param     tracker  tracker
 *  @param[in] image    read during the call only
 *  @param     pts_ns   timestamp of the image in nanoseconds, any value; 5 to 120 images per second
 *                      are expected. A repeated timestamp counts as a step of 1/30 s. A step back,
 *                      or forward by more than 1 s, is a discontinuity: the decoders are reset, and
 *                      a face that is not at its previous place is lost at once
 *  @return MIEN_OK; MIEN_ERROR_NULL_ARGUMENT; MIEN_ERROR_STRUCT_SIZE; a MIEN_ERROR_IMAGE_* status
 */
MIEN_API MIEN_NODISCARD mien_status mien_tracker_push_video(mien_tracker* tracker,
                                                            const mien_image* image,
                                                            int64_t pts_ns);

/** Outputs one frame without an image, for audio without video and for gaps of a camera. A tracked
 *  face counts as missed on it.
 *  @param tracker  tracker
 *  @param pts_ns   timestamp of the frame, as for mien_tracker_push_video
 *  @return MIEN_OK; MIEN_ERROR_NULL_ARGUMENT */
MIEN_API MIEN_NODISCARD mien_status mien_tracker_advance(mien_tracker* tracker, int64_t pts_ns);

/** Processes an audio block of any length. The same samples give bit-identical results however they
 *  are divided into blocks. A block without samples has no effect.
 *
 *  Time: between blocks the number of samples determines the time; differences from the timestamps
 *  of up to 20 ms are corrected gradually, so that two clocks never drift apart. Larger ones are
 *  gaps or repetitions, and the time jumps at once. After a difference of more than 0.5 s the audio
 *  is reset. A change of the sample rate, allowed with any block, continues the stream.
 *
 *  Latency: a frame uses the prediction for the middle of 80 ms of audio, which is complete 42 ms
 *  after the frame's time. Until then the latest prediction is used for up to 150 ms; after that
 *  voice activity falls to 0. Audio may be up to 4 s ahead of the images.
 *
 *  Mixing: every control driven by audio (those of the mouth) becomes
 *
 *      (1 - alpha) v + alpha (w_v v + w_a a)
 *
 *  with v predicted from video, a predicted from audio, alpha = mien_result.voice_activity, and the
 *  control's weights w_v and w_a (mien_tracker_set_mix). Without a face, or if the level of detail
 *  does not drive the control, w_a is 1 and w_v is 0; the transition takes about 0.1 s. With
 *  several faces, audio drives the one with the lowest id.
 *
 *  @param     tracker  tracker
 *  @param[in] audio    read during the call only
 *  @param     pts_ns   timestamp of the first sample in nanoseconds, on the clock of the images
 *  @return MIEN_OK; MIEN_ERROR_NULL_ARGUMENT; MIEN_ERROR_NO_AUDIONET; MIEN_ERROR_STRUCT_SIZE;
 *          MIEN_ERROR_ALIGNMENT; a MIEN_ERROR_AUDIO_* status */
MIEN_API MIEN_NODISCARD mien_status mien_tracker_push_audio(mien_tracker* tracker,
                                                            const mien_audio* audio,
                                                            int64_t pts_ns);

/** Queues an audio block for the next frame (push_video or advance), which processes it as
 *  mien_tracker_push_audio does. For the real-time thread of a microphone: another thread may use
 *  the tracker at the same time, except to create or destroy it. Wait-free: the time depends only
 *  on the number of samples. Use either this function or mien_tracker_push_audio with a tracker,
 *  not both.
 *  @param     tracker  tracker
 *  @param[in] audio    read during the call only
 *  @param     pts_ns   as for mien_tracker_push_audio
 *  @return as mien_tracker_push_audio; MIEN_ERROR_AUDIO_QUEUE_FULL, and nothing is queued, if too
 *          many samples or blocks are waiting (mien_tracker_config.audio_queue_samples); an empty
 *          queue always accepts a block of half its capacity */
MIEN_API MIEN_NODISCARD mien_status mien_tracker_queue_audio(mien_tracker* tracker,
                                                             const mien_audio* audio,
                                                             int64_t pts_ns);

/** Delays audio relative to the images, for audio processed from now on. mien_tracker_reset returns
 *  to 0.
 *  @param tracker    tracker
 *  @param offset_ns  nanoseconds added to the timestamps of audio; any value
 *  @return MIEN_OK; MIEN_ERROR_NULL_ARGUMENT; MIEN_ERROR_NO_AUDIONET */
MIEN_API MIEN_NODISCARD mien_status mien_tracker_set_audio_offset(mien_tracker* tracker,
                                                                  int64_t offset_ns);

/** Sets how a control is mixed during speech (see mien_tracker_push_audio). mien_tracker_reset
 *  restores the weights of the model file.
 *  @param tracker       tracker
 *  @param control       0..MIEN_CONTROL_COUNT - 1
 *  @param audio_weight  w_a, 0..1; 0: audio does not drive the control
 *  @param video_weight  w_v, 0..1
 *  @return MIEN_OK; MIEN_ERROR_NULL_ARGUMENT; MIEN_ERROR_NO_AUDIONET; MIEN_ERROR_OUT_OF_RANGE */
MIEN_API MIEN_NODISCARD mien_status mien_tracker_set_mix(mien_tracker* tracker, int32_t control,
                                                         float audio_weight, float video_weight);

/* Result --------------------------------------------------------------------------------------- */

/** What a tracker knows about a face on a frame. */
typedef enum mien_face_status {
  /** No face since create or reset: box, landmarks, pose and controls not driven by audio are 0. */
  MIEN_FACE_SEARCHING = 0,
  MIEN_FACE_TRACKING = 1, /**< the face is tracked; it may have been missed on this frame */
  /** The face is gone: box, landmarks and pose keep their last values; controls predicted from
   *  video fade to 0 with a time constant of 0.25 s. */
  MIEN_FACE_LOST = 2
} mien_face_status;

/** Name of a face status.
 *  @param status  mien_face_status
 *  @return static string: "searching", "tracking", "lost"; NULL for other numbers */
MIEN_API const char* mien_face_status_name(int32_t status);

/** Parts of the work on a frame: indices into mien_result.stage_ns. */
typedef enum mien_stage {
  MIEN_STAGE_PROPOSAL = 0, /**< detection */
  MIEN_STAGE_WARP = 1,     /**< image to crop */
  MIEN_STAGE_ENCODER = 2,  /**< crop to features */
  MIEN_STAGE_HEADS = 3,    /**< features to landmarks and face probability */
  MIEN_STAGE_DECODERS = 4, /**< features over time to controls and head pose */
  MIEN_STAGE_SOUND = 5,    /**< all audio processed since the previous frame */
  MIEN_STAGE_COUNT = 6
} mien_stage;

/** Name of a stage.
 *  @param stage  mien_stage
 *  @return static string: "proposal", "warp", "encoder", "heads", "decoders", "sound"; NULL for
 *          other numbers */
MIEN_API const char* mien_stage_name(int32_t stage);

/* Bits of mien_result.flags: events of this frame. */
#define MIEN_RESULT_PROPOSAL_RAN 0x1u /**< detection in the whole image ran, or a part of it */
/** An encoder ran. Not set on the alternate frames of levels 1 and 2: box and landmarks stay the
 *  same except for smoothing, while controls and head pose change. */
#define MIEN_RESULT_ENCODER_RAN 0x2u
#define MIEN_RESULT_FOUND 0x4u /**< tracking of a face started or resumed */
#define MIEN_RESULT_CUT 0x8u   /**< timestamp discontinuity */
/** The frame contributes to mien_tracker_capture_neutral. */
#define MIEN_RESULT_CAPTURING_NEUTRAL 0x10u

/** The animation of one face on one frame. Initialize it with mien_result_default. */
typedef struct mien_result {
  uint32_t struct_size;
  int32_t status; /**< mien_face_status */
  int64_t pts_ns; /**< timestamp of the frame, nanoseconds */
  /** Bit i: control i is driven by the level of detail, by a crossfade that has not ended
   *  (mien_tracker_set_lod, up to 2 s) or, after the first audio, by audio. */
  uint64_t supported_controls;

  float face_probability; /**< 0..1, of the latest crop; 0 if detection found none */
  float voice_activity;   /**< 0..1: alpha of mien_tracker_push_audio; 0 without audio */
  int32_t lod;            /**< level of detail of the frame, 1..4 */
  uint32_t flags;         /**< MIEN_RESULT_* */

  float box[4]; /**< x, y, width, height of the whole face in pixels of the upright image */

  float rotation[4]; /**< head to camera: unit quaternion x, y, z, w with w >= 0 */
  /** Radians, -pi/2..pi/2, with the rotation R = Ry(yaw) Rx(pitch) Rz(roll); positive: looks down.
   */
  float pitch;
  float yaw;            /**< radians, -pi..pi; positive: turns to the subject's left */
  float roll;           /**< radians, -pi..pi; right-hand rule about z */
  float translation[3]; /**< metres: the head's origin in camera space */

  float controls[MIEN_CONTROL_COUNT]; /**< 0..1, from video and audio; 0 where not supported */
  /** x, y in pixels of the upright image; may lie outside it. Order: models/landmarks.json. */
  float landmarks[MIEN_LANDMARK_COUNT][2];

  /* Totals since create or reset. */
  uint64_t frames;        /**< frames with and without an image */
  uint64_t face_frames;   /**< frames with a tracked face */
  uint64_t proposal_runs; /**< detections in the whole image that were started */
  uint64_t encoder_runs;  /**< runs of BaseNet and HiFiNet */

  /** Nanoseconds in each mien_stage on this frame; 0 without a clock. */
  uint64_t stage_ns[MIEN_MAX_STAGES];

  /** Number of the face, from 1 in the order of detection; 0 before the first. A face that is found
   *  again within 2 s near the place where it was lost keeps its id. */
  uint32_t face_id;

  uint32_t reserved[15];
} mien_result;

/** Copies the result of the latest frame; of several faces, that of the lowest id. Before the first
 *  frame it is MIEN_FACE_SEARCHING and zeros.
 *  @param[in]     tracker  tracker
 *  @param[in,out] result   struct_size bytes are written
 *  @return MIEN_OK; MIEN_ERROR_NULL_ARGUMENT; MIEN_ERROR_STRUCT_SIZE */
MIEN_API MIEN_NODISCARD mien_status mien_tracker_get_result(const mien_tracker* tracker,
                                                            mien_result* result);

/** Number of known faces after the latest frame: tracked faces, faces lost less than 2 s ago, and
 *  the last known one, however long ago it was lost.
 *  @param[in] tracker  tracker
 *  @return 0..max_faces; 0 for NULL */
MIEN_API int32_t mien_tracker_face_count(const mien_tracker* tracker);

/** Copies the result of one known face. Totals, stage times and most flags are those of the frame;
 *  MIEN_RESULT_ENCODER_RAN, MIEN_RESULT_FOUND and MIEN_RESULT_CAPTURING_NEUTRAL are the face's own.
 *  @param[in]     tracker  tracker
 *  @param         index    0..mien_tracker_face_count - 1, in the order of ids
 *  @param[in,out] result   struct_size bytes are written
 *  @return MIEN_OK; MIEN_ERROR_NULL_ARGUMENT; MIEN_ERROR_STRUCT_SIZE; MIEN_ERROR_OUT_OF_RANGE */
MIEN_API MIEN_NODISCARD mien_status mien_tracker_get_face(const mien_tracker* tracker,
                                                          int32_t index, mien_result* result);

/** Initializes a result: struct_size, all other fields 0.
 *  @param[out] result  NULL is ignored */
MIEN_API void mien_result_default(mien_result* result);

/* Neutral calibration -------------------------------------------------------------------------- */

/* Some faces look raised, pressed or half closed at rest. Neutral calibration captures a person's
 * controls at rest and removes them from later frames: max(0, (control - neutral) / (1 - neutral)).
 * A full blink stays 1. It needs max_faces = 1 and stays in effect, also for other persons, until
 * mien_tracker_reset. */

/** Starts a capture at the current level of detail, while the person has a neutral face.
 *
 *  After 10 frames to settle, the neutral value of each control is its median over 45 frames, at
 *  most 0.6; the median ignores blinks. These frames have MIEN_RESULT_CAPTURING_NEUTRAL. The
 *  capture then replaces an earlier one. It pauses without a face and restarts after a loss, a
 *  discontinuity, or a change of the level between 1 and the others.
 *
 *  @param tracker  tracker
 *  @return MIEN_OK; MIEN_ERROR_NULL_ARGUMENT; MIEN_ERROR_SEVERAL_FACES if max_faces > 1 */
MIEN_API MIEN_NODISCARD mien_status mien_tracker_capture_neutral(mien_tracker* tracker);

#define MIEN_NEUTRAL_BYTES 448 /**< size of a neutral file (docs/format.md) */

/** Writes the captured neutral values as a file.
 *  @param[in]  tracker     tracker
 *  @param[out] file        [MIEN_NEUTRAL_BYTES]
 *  @param      file_bytes  size of `file` in bytes
 *  @param[out] captured    bit 0: level 1 is captured; bit 1: levels 2 to 4, which share one
 *                          capture; may be NULL
 *  @return MIEN_OK; MIEN_ERROR_NULL_ARGUMENT; MIEN_ERROR_SEVERAL_FACES;
 *          MIEN_ERROR_MEMORY_TOO_SMALL if file_bytes < MIEN_NEUTRAL_BYTES */
MIEN_API MIEN_NODISCARD mien_status mien_tracker_save_neutral(const mien_tracker* tracker,
                                                              void* file, size_t file_bytes,
                                                              uint32_t* captured);

/** Restores neutral values from a file. Levels that it did not capture keep theirs.
 *  @param     tracker     tracker
 *  @param[in] file        [file_bytes] of mien_tracker_save_neutral
 *  @param     file_bytes  size in bytes
 *  @return MIEN_OK; MIEN_ERROR_NULL_ARGUMENT; MIEN_ERROR_SEVERAL_FACES; a MIEN_ERROR_NEUTRAL_*
 *          status */
MIEN_API MIEN_NODISCARD mien_status mien_tracker_load_neutral(mien_tracker* tracker,
                                                              const void* file, size_t file_bytes);

/* Custom networks ------------------------------------------------------------------------------ */

/** Any network of a weight file, for example one that mien_convert made from an ONNX file. One
 *  thread at a time may use a network.
 *
 *      mien_network_config config;
 *      mien_network_config_default(&config);
 *      config.weights = weights;  config.name = "encoder";
 *      mien_network* network = NULL;
 *      if (mien_network_create(&config, &network, NULL) != MIEN_OK) return 1;
 *      for (int i = 0; i < count; ++i) {
 *        memcpy(mien_network_input(network, NULL), images[i], image_bytes);
 *        if (mien_network_run(network) == MIEN_OK) use(mien_network_output(network, 0, NULL));
 *      }
 *      mien_network_destroy(network);
 *
 *  Layout: an input of at most 4 channels and more than one pixel is [height][width][channels].
 *  Every other map is stored in blocks of 8 channels, [ceil(channels / 8)][height][width][8], with
 *  unused lanes zero. A vector of n values is therefore n floats, rounded up to a multiple of 8.
 *
 *  State: temporal layers (causal convolution, LSTM) keep their state in the network; one run is
 *  one step of the stream. LSTM state below 1e-30 is flushed to zero, because denormal numbers are
 *  slow. */
typedef struct mien_network mien_network;

/** Shape of a map in rows, columns and channels, each at least 1; a vector is {1, 1, channels}. */
typedef struct mien_shape {
  int32_t height, width, channels;
} mien_shape;

/** Configuration of a network. Initialize it with mien_network_config_default; only `weights` has
 *  no default. */
typedef struct mien_network_config {
  uint32_t struct_size;
  /** Allowed tiers, and MIEN_CPU_FUSED; default MIEN_CPU_ALL without MIEN_CPU_HALF, because the
   *  values of a custom network are unbounded. */
  uint32_t cpu_mask;
  const mien_weights* weights;
  const char* name; /**< of a network of the weights; default NULL: the first */
  /** Size of the input in rows and columns, for networks that accept several; default 0, 0: the
   *  declared size. */
  int32_t height, width;
  mien_allocator allocator; /**< default: both callbacks NULL, which selects the C library's */
  uint32_t reserved[8];
} mien_network_config;

/** Initializes a configuration with the defaults; the weights are NULL.
 *  @param[out] config  NULL is ignored */
MIEN_API void mien_network_config_default(mien_network_config* config);

/** Creates a network with one allocation by config->allocator. Copies the configuration, and refers
 *  to the weights.
 *  @param[in]  config   configuration
 *  @param[out] network  owned by the caller, who ends it with mien_network_destroy; NULL on error,
 *                       when nothing stays allocated
 *  @param[out] error    describes the error; may be NULL
 *  @return MIEN_OK; MIEN_ERROR_NULL_ARGUMENT; MIEN_ERROR_STRUCT_SIZE; MIEN_ERROR_OUT_OF_RANGE;
 *          MIEN_ERROR_OUT_OF_MEMORY; MIEN_ERROR_WEIGHTS_INCOMPLETE for an unknown name;
 *          MIEN_ERROR_WEIGHTS_SHAPE for an unsupported size of the input; MIEN_ERROR_TOO_LARGE;
 *          MIEN_ERROR_UNSUPPORTED_LAYER; MIEN_ERROR_UNSUPPORTED_LAYOUT; MIEN_ERROR_INTERNAL */
MIEN_API MIEN_NODISCARD mien_status mien_network_create(const mien_network_config* config,
                                                        mien_network** network,
                                                        mien_error_detail* error);

/** Computes the size of the memory for mien_network_create_in.
 *  @param[in]  config  configuration
 *  @param[out] bytes   size in bytes; 0 on error
 *  @param[out] error   describes the error; may be NULL
 *  @return a status of mien_network_create other than MIEN_ERROR_OUT_OF_MEMORY */
MIEN_API MIEN_NODISCARD mien_status mien_network_required_bytes(const mien_network_config* config,
                                                                size_t* bytes,
                                                                mien_error_detail* error);

/** Creates a network in memory of the caller, without calling the allocator.
 *  @param[in]  config        configuration
 *  @param      memory        [memory_bytes], MIEN_ALIGNMENT-aligned; must outlive the network; its
 *                            content is unspecified after an error
 *  @param      memory_bytes  at least mien_network_required_bytes
 *  @param[out] network       NULL on error
 *  @param[out] error         describes the error; may be NULL
 *  @return as mien_network_create; MIEN_ERROR_MEMORY_TOO_SMALL; MIEN_ERROR_ALIGNMENT */
MIEN_API MIEN_NODISCARD mien_status mien_network_create_in(const mien_network_config* config,
                                                           void* memory, size_t memory_bytes,
                                                           mien_network** network,
                                                           mien_error_detail* error);

/** Releases a network; after mien_network_create_in the memory stays with the caller.
 *  @param network  NULL is ignored */
MIEN_API void mien_network_destroy(mien_network* network);

/** Buffer for the input, initially zeros.
 *  @param      network  network
 *  @param[out] shape    shape of the input; may be NULL
 *  @return memory of the network, in the layout of mien_network; NULL for NULL */
MIEN_API float* mien_network_input(mien_network* network, mien_shape* shape);

/** Runs a network once on the content of its input; for a temporal network that is one step.
 *  @param network  network
 *  @return MIEN_OK; MIEN_ERROR_NULL_ARGUMENT */
MIEN_API MIEN_NODISCARD mien_status mien_network_run(mien_network* network);

/** Number of outputs.
 *  @param[in] network  network
 *  @return number; 0 for NULL */
MIEN_API int32_t mien_network_output_count(const mien_network* network);

/** An output of the latest run, valid until the next run.
 *  @param[in]  network  network
 *  @param      index    0..mien_network_output_count - 1
 *  @param[out] shape    shape of the output; may be NULL
 *  @return memory of the network; NULL for NULL or an index outside the range */
MIEN_API const float* mien_network_output(const mien_network* network, int32_t index,
                                          mien_shape* shape);

/** Resets the state of temporal layers to the start of a stream.
 *  @param network  NULL is ignored */
MIEN_API void mien_network_reset(mien_network* network);

/** Number of steps of a run. A step computes one layer, or several fused layers.
 *  @param[in] network  network
 *  @return number; 0 for NULL */
MIEN_API int32_t mien_network_step_count(const mien_network* network);

/** Layers of a step.
 *  @param[in]  network  network
 *  @param      step     0..mien_network_step_count - 1
 *  @param[out] first    index of the first layer, from 0; may be NULL
 *  @return number of layers; 0 for NULL or a step outside the range */
MIEN_API int32_t mien_network_step_layers(const mien_network* network, int32_t step,
                                          int32_t* first);

/** Runs one step, to measure it. Running all steps in order is mien_network_run.
 *  @param network  network
 *  @param step     0..mien_network_step_count - 1
 *  @return MIEN_OK; MIEN_ERROR_NULL_ARGUMENT; MIEN_ERROR_OUT_OF_RANGE */
MIEN_API MIEN_NODISCARD mien_status mien_network_run_step(mien_network* network, int32_t step);

/* Content of weights --------------------------------------------------------------------------- */

/* Networks, metadata and constants of all files, in the order of mien_weights_config.files. The
 * caller sets struct_size of every info; strings stay valid as long as the weights. */

/** A network. */
typedef struct mien_network_info {
  uint32_t struct_size;
  int32_t file;                       /**< index in mien_weights_config.files */
  char name[MIEN_MAX_NAME_BYTES + 1]; /**< terminated */
  mien_shape input;                   /**< the declared input */
  int32_t any_size;                   /**< not 0: also accepts larger inputs */
  int32_t layers;                     /**< number of layers */
  int32_t outputs;                    /**< number of outputs */
  uint64_t parameters;                /**< number of weights, biases and slopes */
  uint64_t macs;                      /**< multiply-accumulates per run on the declared input */
  uint64_t weight_bytes;              /**< bytes of the parameters in the file */
  uint64_t session_bytes; /**< bytes of input, outputs and state, with the default configuration */
  uint64_t arena_bytes;   /**< bytes of intermediate maps, likewise */
  uint32_t reserved[8];
} mien_network_info;

/** A layer. */
typedef struct mien_layer_info {
  uint32_t struct_size;
  int32_t input;          /**< 0: the network's input; k: the output of the k-th layer, from 1 */
  int32_t second_input;   /**< likewise; -1: none */
  mien_shape output;      /**< for the declared input */
  const char* op;         /**< static string: "conv2d", ... */
  const char* activation; /**< static string: "none", "relu", ... */
  int32_t kernel[2];      /**< rows, columns; 0 without a window */
  int32_t stride[2];      /**< rows, columns */
  int32_t padding[4];     /**< top, left, bottom, right; of a slice: what it removes */
  int32_t first_channel;  /**< slice only */
  float input_bound;      /**< pointwise with 8-bit inputs: their largest magnitude; else 0 */
  uint64_t parameters;    /**< number of weights, biases and slopes */
  uint64_t macs;          /**< multiply-accumulates per run on the declared input */
  uint32_t reserved[8];
} mien_layer_info;

/** A key and its value from the metadata of a file. */
typedef struct mien_metadata_info {
  uint32_t struct_size;
  int32_t file;                      /**< index in mien_weights_config.files */
  char key[MIEN_MAX_NAME_BYTES + 1]; /**< terminated */
  const char* value;                 /**< [value_bytes], UTF-8, not terminated */
  size_t value_bytes;                /**< length of `value` in bytes */
  uint32_t reserved[8];
} mien_metadata_info;

/** A named constant. */
typedef struct mien_constant_info {
  uint32_t struct_size;
  int32_t file;                       /**< index in mien_weights_config.files */
  char name[MIEN_MAX_NAME_BYTES + 1]; /**< terminated */
  const char* type;                   /**< static string: "fp16" or "fp32" */
  int32_t rank;                       /**< 1..4 */
  uint32_t dims[4];                   /**< rank of them; the others are 0 */
  uint32_t reserved[8];
} mien_constant_info;

/** Number of networks. @param[in] weights  weights @return number; 0 for NULL */
MIEN_API int32_t mien_weights_network_count(const mien_weights* weights);

/** Describes a network. Needs up to 96 KiB of stack.
 *  @param[in]     weights  weights
 *  @param         network  0..mien_weights_network_count - 1
 *  @param[in,out] info     struct_size bytes are written
 *  @return MIEN_OK; MIEN_ERROR_NULL_ARGUMENT; MIEN_ERROR_OUT_OF_RANGE; MIEN_ERROR_STRUCT_SIZE */
MIEN_API MIEN_NODISCARD mien_status mien_weights_network(const mien_weights* weights,
                                                         int32_t network, mien_network_info* info);

/** Describes a layer of a network.
 *  @param[in]     weights  weights
 *  @param         network  0..mien_weights_network_count - 1
 *  @param         layer    0..mien_network_info.layers - 1
 *  @param[in,out] info     struct_size bytes are written
 *  @return as mien_weights_network */
MIEN_API MIEN_NODISCARD mien_status mien_weights_layer(const mien_weights* weights, int32_t network,
                                                       int32_t layer, mien_layer_info* info);

/** Number of metadata entries. @param[in] weights  weights @return number; 0 for NULL */
MIEN_API int32_t mien_weights_metadata_count(const mien_weights* weights);

/** Reads a metadata entry.
 *  @param[in]     weights  weights
 *  @param         index    0..mien_weights_metadata_count - 1
 *  @param[in,out] info     struct_size bytes are written
 *  @return as mien_weights_network */
MIEN_API MIEN_NODISCARD mien_status mien_weights_metadata(const mien_weights* weights,
                                                          int32_t index, mien_metadata_info* info);

/** Number of named constants. @param[in] weights  weights @return number; 0 for NULL */
MIEN_API int32_t mien_weights_constant_count(const mien_weights* weights);

/** Describes a named constant.
 *  @param[in]     weights  weights
 *  @param         index    0..mien_weights_constant_count - 1
 *  @param[in,out] info     struct_size bytes are written
 *  @return as mien_weights_network */
MIEN_API MIEN_NODISCARD mien_status mien_weights_constant(const mien_weights* weights,
                                                          int32_t index, mien_constant_info* info);

#ifdef __cplusplus
}
#endif

#endif /* MIEN_MIEN_H_ */
