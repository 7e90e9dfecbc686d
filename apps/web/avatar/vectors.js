// Arithmetic for all parts of the avatar. Points are arrays [x, y, z] in head space: x to the subject's left (right in
// the image), y up, z out of the face; the unit is half the width of the head.

export const mix = (a, b, t) => a + (b - a) * t;
export const clamp01 = value => Math.min(1, Math.max(0, value));
export const smoothstep = (from, to, value) => {
  const t = clamp01((value - from) / (to - from));
  return t * t * (3 - 2 * t);
};
// 1 in the middle, falling off with widths `sizeX` and `sizeY`.
export const bump = (x, y, sizeX, sizeY = sizeX) => Math.exp(-((x / sizeX) ** 2) - (y / sizeY) ** 2);

export const add = (a, b, scale = 1) => [a[0] + b[0] * scale, a[1] + b[1] * scale, a[2] + b[2] * scale];
export const subtract = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const normalize = a => {
  const length = Math.hypot(a[0], a[1], a[2]) || 1;
  return [a[0] / length, a[1] / length, a[2] / length];
};

// Names of controls end in Left or Right; `side` is 1 for the subject's left, -1 for the right.
export const sideName = side => (side > 0 ? 'Left' : 'Right');

// Column-major 3 x 3 of angles as in mien_result: R = Ry(yaw) Rx(pitch) Rz(roll), positive pitch looks down.
export function rotationOfAngles({pitch, yaw, roll}) {
  const turn = ([x, y, z]) => {
    [x, y] = [x * Math.cos(roll) - y * Math.sin(roll), x * Math.sin(roll) + y * Math.cos(roll)];
    [y, z] = [y * Math.cos(pitch) - z * Math.sin(pitch), y * Math.sin(pitch) + z * Math.cos(pitch)];
    return [z * Math.sin(yaw) + x * Math.cos(yaw), y, z * Math.cos(yaw) - x * Math.sin(yaw)];
  };
  return [...turn([1, 0, 0]), ...turn([0, 1, 0]), ...turn([0, 0, 1])];
}
