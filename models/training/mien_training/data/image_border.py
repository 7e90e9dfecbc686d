"""Images under affine maps, and beyond their border, without PyTorch, which the environment of the teacher lacks."""
import cv2
import numpy as np


def continued(image, share=0.6):
    """The image with a blurred border of this share of its height around it, and the border's width: tight images
    end at a chin."""
    margin = int(share * image.shape[0])
    out = cv2.copyMakeBorder(image, *[margin] * 4, cv2.BORDER_REFLECT_101)
    inside = cv2.copyMakeBorder(np.ones(image.shape[:2], np.float32), *[margin] * 4, cv2.BORDER_CONSTANT)
    coarse = lambda x: cv2.resize(x, None, fx=0.125, fy=0.125, interpolation=cv2.INTER_AREA)
    fine = lambda x: cv2.resize(x, out.shape[1::-1], interpolation=cv2.INTER_LINEAR)
    soft = fine(cv2.GaussianBlur(coarse(out), (0, 0), 3))
    sharp = np.maximum(inside, fine(cv2.GaussianBlur(coarse(inside), (0, 0), 1.5)))[..., None]
    return np.uint8(out * sharp + soft * (1 - sharp) + 0.5), margin


def warped(image, matrix, size_wh):
    """The image under an affine map [2,3] of points whose pixels have their edges at whole numbers."""
    centred = matrix.copy()  # OpenCV has the pixels' centres there
    centred[:, 2] += (matrix[:, :2].sum(1) - 1) / 2
    return cv2.warpAffine(image, centred, size_wh, flags=cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
