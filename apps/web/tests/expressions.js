// Faces that combine several controls.
const both = (name, value) => ({[name + 'Left']: value, [name + 'Right']: value});

export const expressions = [
  {name: 'smile', controls: {...both('mouthSmile', 0.9), ...both('cheekSquint', 0.5), ...both('eyeSquint', 0.25), jawOpen: 0.12, ...both('mouthUpperUp', 0.35)}},
  {name: 'smile with blink', controls: {...both('mouthSmile', 0.8), ...both('cheekSquint', 0.6), ...both('eyeBlink', 1)}},
  {name: 'wink', controls: {eyeBlinkLeft: 1, eyeSquintLeft: 0.4, cheekSquintLeft: 0.7, mouthSmileLeft: 0.8, mouthSmileRight: 0.25, browOuterUpRight: 0.5}, roll: 0.1},
  {name: 'surprise', controls: {...both('eyeWide', 1), browInnerUp: 0.9, ...both('browOuterUp', 0.9), jawOpen: 0.65, mouthFunnel: 0.25}},
  {name: 'sad', controls: {browInnerUp: 1, ...both('mouthFrown', 0.8), mouthShrugLower: 0.4, ...both('eyeLookDown', 0.4), ...both('eyeSquint', 0.2)}, pitch: 0.12},
  {name: 'angry', controls: {...both('browDown', 1), ...both('eyeSquint', 0.5), ...both('noseSneer', 0.6), ...both('mouthPress', 0.5), ...both('mouthFrown', 0.4)}},
  {name: 'laugh', controls: {...both('mouthSmile', 1), ...both('cheekSquint', 1), ...both('eyeSquint', 0.6), ...both('eyeBlink', 0.5), jawOpen: 0.6, ...both('mouthUpperUp', 0.4)}, pitch: -0.15},
  {name: 'disgust', controls: {...both('noseSneer', 1), ...both('mouthUpperUp', 0.5), ...both('browDown', 0.6), ...both('eyeSquint', 0.5), tongueOut: 0.6}},
  {name: 'says aa', controls: {jawOpen: 0.6, ...both('mouthLowerDown', 0.3)}},
  {name: 'says ee', controls: {jawOpen: 0.15, ...both('mouthSmile', 0.4), ...both('mouthStretch', 0.6), ...both('mouthLowerDown', 0.5), ...both('mouthUpperUp', 0.3)}},
  {name: 'says oh', controls: {jawOpen: 0.35, mouthFunnel: 0.7}},
  {name: 'says oo', controls: {jawOpen: 0.12, mouthPucker: 0.9, mouthFunnel: 0.2}},
  {name: 'says f', controls: {jawOpen: 0.1, mouthRollLower: 0.6, ...both('mouthUpperUp', 0.4)}},
  {name: 'says m', controls: {jawOpen: 0.15, mouthClose: 0.15, ...both('mouthPress', 0.5), mouthRollLower: 0.2, mouthRollUpper: 0.2}},
  {name: 'chews', controls: {jawOpen: 0.5, mouthClose: 0.5, jawLeft: 0.3}},
  {name: 'looks up left', controls: {...both('eyeLookUp', 0.7), eyeLookOutLeft: 0.8, eyeLookInRight: 0.8, browInnerUp: 0.3}},
  {name: 'turned left', controls: {...both('mouthSmile', 0.4)}, yaw: 0.6},
  {name: 'turned right', controls: {jawOpen: 0.2}, yaw: -0.6},
  {name: 'nods', controls: {...both('mouthSmile', 0.3)}, pitch: 0.4},
];
