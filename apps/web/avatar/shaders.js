// Lights: one from above the viewer's left shoulder, a cool one from the other side, sky and ground, and a rim light.
// Slowly varying terms are computed per vertex, because vertices are far fewer than pixels, and without a graphics card
// the processor computes every pixel.

export const vertexShader = `#version 300 es
in vec3 positions, normals, colors, rest;
in float turning;
in float material;
uniform mat3 head;       // head to camera
uniform vec3 pivot;      // the centre of the head's rotation, in the neck
uniform vec2 scale;      // from the scene to the image
uniform float distanceToEye, height;
uniform vec4 shades[9];  // of each material: colour in shadow, and how far light wraps around
uniform vec4 finishes[9];  // kind, gloss, size of highlights, and brightness of the rim light
uniform vec2 lids;       // upper lids of the subject's left and right eye
out vec3 vNormal, vColor, vRest, vToEye;
out vec3 vPolish;        // gloss, size of highlights (as a power of 2), and 1 / length of light + view
out float vLid, vEdge;
flat out int kind;

const vec3 key = vec3(-0.4116, 0.5671, 0.7134), fill = vec3(0.8833, 0.0520, 0.4676);

// The light on a surface with normal \`n\`.
vec3 lightOn(vec3 n, vec4 shade) {
  float light = smoothstep(-shade.w, 1.0, dot(n, key));
  return mix(shade.rgb * 0.78, vec3(1.04, 1.02, 0.98), light) + vec3(0.10, 0.13, 0.18) * max(dot(n, fill), 0.0) +
    mix(vec3(0.03, 0.02, 0.02), vec3(0.10, 0.11, 0.13), n.y * 0.5 + 0.5);
}

void main() {
  vec4 shade = shades[int(material)], finish = finishes[int(material)];
  vec3 turned = head * (positions - pivot) + pivot;
  vec3 at = mix(positions, turned, turning);
  vec3 n = normalize(normals);
  kind = int(finish.x);
  vNormal = mix(n, head * n, turning);
  vColor = colors * lightOn(normalize(vNormal), shade);
  if (kind == 2) vColor *= smoothstep(0.15, 0.75, at.z) * 0.75 + 0.25;  // the inside of the mouth is dark
  vToEye = normalize(vec3(0.0, 0.0, distanceToEye) - at);
  float lips = kind == 0 ? smoothstep(0.06, 0.16, colors.r - colors.g * 1.42) : 0.0;
  vPolish = vec3(mix(finish.yz, vec2(0.30, 45.0), lips) * vec2(1.0, 1.4427), inversesqrt(2.0 + 2.0 * dot(key, vToEye)));
  vEdge = finish.w;
  vRest = rest;
  vLid = positions.x > 0.0 ? lids.x : lids.y;
  float away = distanceToEye - at.z;
  gl_Position = vec4(at.x * scale.x * distanceToEye, (at.y - height) * scale.y * distanceToEye, (away - distanceToEye) * 0.25 * away, away);
}`;

export const fragmentShader = `#version 300 es
precision highp float;
in vec3 vNormal, vColor, vRest, vToEye;
in vec3 vPolish;
in float vLid, vEdge;
flat in int kind;        // 0 skin with creases, 1 eye, 2 inside the mouth, 3 other
out vec4 fragment;
uniform vec4 creaseField;
uniform sampler2D creases;
uniform float pupil;

const vec3 key = vec3(-0.4116, 0.5671, 0.7134);

float crease() {
  vec2 at = (vec2(abs(vRest.x), vRest.y) - creaseField.xy) * creaseField.zw;
  if (vRest.z < 0.0 || at.x > 1.0 || at.y < 0.0 || at.y > 1.0) return 0.0;
  vec2 sides = texture(creases, at).rg;
  return mix(sides.g, sides.r, smoothstep(-0.05, 0.05, vRest.x));
}

// The eyeball: \`vRest\` is the point on a unit sphere around the z axis.
vec3 iris() {
  float r = length(vRest.xy) / max(0.2, length(vRest));
  if (vRest.z < 0.0) r = 1.0;
  float soft = fwidth(r) * 0.8 + 0.004;
  float around = atan(vRest.y, vRest.x);
  float fibre = 0.5 + 0.5 * sin(around * 38.0 + 5.0 * sin(around * 7.0)) * sin(around * 17.0);
  vec3 green = mix(vec3(0.16, 0.36, 0.30), vec3(0.45, 0.66, 0.44), smoothstep(0.50, 0.2, r) * 0.75 + 0.25 * fibre * smoothstep(0.2, 0.3, r));
  green += vec3(0.16, 0.15, 0.05) * smoothstep(-0.1, -0.5, vRest.y);
  vec3 white = mix(vec3(0.99, 0.975, 0.955), vec3(0.90, 0.78, 0.74), smoothstep(0.62, 1.0, r));
  vec3 color = mix(green, vec3(0.07, 0.14, 0.13), smoothstep(0.40, 0.50, r) * 0.85);
  color = mix(color, vec3(0.03, 0.025, 0.03), 1.0 - smoothstep(pupil - soft, pupil + soft, r));
  return mix(color, white, smoothstep(0.50 - soft, 0.50 + soft, r));
}

// In the shadow of the lid, with two highlights.
vec3 eyeball(vec3 n) {
  vec3 color = vColor * iris() * (0.74 + 0.26 * smoothstep(0.16, -0.10, vRest.y - vLid * 0.62 + 0.12));
  float spot = smoothstep(0.968, 0.982, dot(n, normalize(vec3(-0.42, 0.46, 0.85))));
  float second = smoothstep(0.985, 0.995, dot(n, normalize(vec3(0.30, -0.30, 0.9)))) * 0.30;
  return mix(color, vec3(1.0), max(spot, second) * 0.95);
}

void main() {
  vec3 n = normalize(vNormal), color = vColor;
  if (kind == 1) {
    color = eyeball(n);
  } else {
    float facing = dot(n, vToEye), away = 1.0 - clamp(facing, 0.0, 1.0);
    color += vEdge * away * away * away * smoothstep(-0.2, 0.6, n.y + n.x * 0.3) * (vColor * 0.6 + 0.3);
    color += vPolish.x * exp2(vPolish.y * ((dot(n, key) + facing) * vPolish.z - 1.0));  // near 1 a power of the term in brackets
    if (kind == 0) color *= 1.0 - vec3(0.32, 0.51, 0.54) * crease();
  }
  fragment = vec4(color, 1.0);
}`;
