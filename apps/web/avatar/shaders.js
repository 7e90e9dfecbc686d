// One light from above the viewer's left shoulder, a cool one from the other side, sky and ground, and an edge of light.

export const vertexShader = `#version 300 es
in vec3 position, normal, color, rest;
in float turning;
uniform mat3 head;       // head to camera
uniform vec3 pivot;      // where the head turns about, in the neck
uniform vec2 scale;      // of the picture
uniform float distanceToEye, height;
out vec3 vPosition, vNormal, vColor, vRest;
void main() {
  vec3 turned = head * (position - pivot) + pivot;
  vec3 at = mix(position, turned, turning);
  vNormal = mix(normalize(normal), head * normalize(normal), turning);
  vPosition = at;
  vColor = color;
  vRest = rest;
  float away = distanceToEye - at.z;
  gl_Position = vec4(at.x * scale.x * distanceToEye, (at.y - height) * scale.y * distanceToEye, (away - distanceToEye) * 0.25 * away, away);
}`;

export const fragmentShader = `#version 300 es
precision highp float;
in vec3 vPosition, vNormal, vColor, vRest;
out vec4 fragment;
uniform int material;    // 0 skin, 1 lid, 2 eye, 3 hair, 4 wet, 5 dark, 6 cloth, 7 neck, 8 brow
uniform float distanceToEye;
uniform vec4 creaseField;
uniform vec4 leftDepths[4], rightDepths[4];
uniform sampler2D creases0, creases1, creases2, creases3;
uniform vec3 pupil;      // x: size, y and z: upper lids of the subject's left and right eye

float crease() {
  vec2 at = (vec2(abs(vRest.x), vRest.y) - creaseField.xy) * creaseField.zw;
  if (vRest.z < 0.0 || at.x > 1.0 || at.y < 0.0 || at.y > 1.0) return 0.0;
  float left = smoothstep(-0.05, 0.05, vRest.x);
  float dark = dot(texture(creases0, at), mix(rightDepths[0], leftDepths[0], left));
  dark += dot(texture(creases1, at), mix(rightDepths[1], leftDepths[1], left));
  dark += dot(texture(creases2, at), mix(rightDepths[2], leftDepths[2], left));
  dark += dot(texture(creases3, at), mix(rightDepths[3], leftDepths[3], left));
  return min(dark, 1.0);
}

// The eyeball: \`vRest\` is the point on a unit sphere that looks along z.
vec3 iris(out float wet) {
  float r = length(vRest.xy) / max(0.2, length(vRest));
  if (vRest.z < 0.0) r = 1.0;
  float soft = fwidth(r) * 0.8 + 0.004;
  float around = atan(vRest.y, vRest.x);
  float fibre = 0.5 + 0.5 * sin(around * 38.0 + 5.0 * sin(around * 7.0)) * sin(around * 17.0);
  vec3 green = mix(vec3(0.16, 0.36, 0.30), vec3(0.45, 0.66, 0.44), smoothstep(0.50, 0.2, r) * 0.75 + 0.25 * fibre * smoothstep(0.2, 0.3, r));
  green += vec3(0.16, 0.15, 0.05) * smoothstep(-0.1, -0.5, vRest.y);
  vec3 white = mix(vec3(0.99, 0.975, 0.955), vec3(0.90, 0.78, 0.74), smoothstep(0.62, 1.0, r));
  vec3 color = mix(green, vec3(0.07, 0.14, 0.13), smoothstep(0.40, 0.50, r) * 0.85);
  color = mix(color, vec3(0.03, 0.025, 0.03), 1.0 - smoothstep(pupil.x - soft, pupil.x + soft, r));
  wet = 1.0;
  return mix(color, white, smoothstep(0.50 - soft, 0.50 + soft, r));
}

void main() {
  vec3 toEye = normalize(vec3(0.0, 0.0, distanceToEye) - vPosition);
  vec3 n = normalize(vNormal);
  if (dot(n, toEye) < 0.0 && material != 2) n = -n;
  vec3 albedo = vColor;
  float gloss = 0.0, shine = 12.0, wrap = 0.35, fold = 0.0, wet = 0.0;
  vec3 shadow = vec3(0.50, 0.45, 0.55);
  if (material == 0 || material == 1 || material == 7) {
    wrap = 0.55;
    shadow = vec3(0.70, 0.47, 0.44);
    gloss = 0.10;
    shine = 22.0;
    if (material == 0) {
      float lips = smoothstep(0.06, 0.16, vColor.r - vColor.g * 1.42);
      gloss = mix(gloss, 0.30, lips);
      shine = mix(shine, 45.0, lips);
      fold = crease();
    }
  } else if (material == 2) {
    albedo = iris(wet);
    wrap = 0.7;
    shadow = vec3(0.72, 0.68, 0.75);
  } else if (material == 3) {
    gloss = 0.22;
    shine = 16.0;
    wrap = 0.3;
    shadow = vec3(0.45, 0.38, 0.42);
  } else if (material == 4) {
    gloss = 0.35;
    shine = 50.0;
    shadow = vec3(0.62, 0.45, 0.48);
    albedo *= smoothstep(0.15, 0.75, vPosition.z) * 0.75 + 0.25;
  } else if (material == 6) {
    gloss = 0.03;
    shadow = vec3(0.55, 0.55, 0.68);
  }

  vec3 key = normalize(vec3(-0.45, 0.62, 0.78)), fill = normalize(vec3(0.85, 0.05, 0.45));
  float light = clamp((dot(n, key) + wrap) / (1.0 + wrap), 0.0, 1.0);
  light = light * light * (3.0 - 2.0 * light);
  vec3 color = albedo * mix(shadow * 0.78, vec3(1.04, 1.02, 0.98), light);
  color += albedo * vec3(0.10, 0.13, 0.18) * clamp(dot(n, fill), 0.0, 1.0);
  color += albedo * mix(vec3(0.03, 0.02, 0.02), vec3(0.10, 0.11, 0.13), n.y * 0.5 + 0.5);
  float edge = pow(1.0 - clamp(dot(n, toEye), 0.0, 1.0), 3.0);
  color += (0.16 * edge * smoothstep(-0.2, 0.6, n.y + n.x * 0.3)) * (albedo * 0.6 + 0.3) * (material == 2 || material == 5 ? 0.0 : 1.0);
  color += gloss * pow(max(0.0, dot(n, normalize(key + toEye))), shine);
  color *= mix(vec3(1.0), vec3(0.62, 0.40, 0.36), fold * 0.85);
  if (material == 2) {
    float lid = vPosition.x > 0.0 ? pupil.y : pupil.z;
    vec3 ball = vPosition;
    color *= 0.74 + 0.26 * smoothstep(0.16, -0.10, vRest.y - lid * 0.62 + 0.12);
    vec3 glint = normalize(vec3(-0.42, 0.46, 0.85));
    float spot = smoothstep(0.968, 0.982, dot(normalize(vNormal), glint));
    float second = smoothstep(0.985, 0.995, dot(normalize(vNormal), normalize(vec3(0.30, -0.30, 0.9)))) * 0.30;
    color = mix(color, vec3(1.0), max(spot, second) * 0.95);
  }
  fragment = vec4(color, 1.0);
}`;
