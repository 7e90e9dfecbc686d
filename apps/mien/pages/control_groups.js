// Groups of controls, in display order.

const controlGroups = [
  {key: 'eyes', title: 'Eyes', hint: 'blinks, squinting, widening', of: /^eye(Blink|Squint|Wide)/},
  {key: 'gaze', title: 'Gaze', hint: 'where the eyes look', of: /^eyeLook/},
  {key: 'brows', title: 'Brows', hint: 'raised, lowered, knitted', of: /^brow/},
  {key: 'jaw', title: 'Jaw', hint: 'opening, to the sides, forward', of: /^jaw/},
  {key: 'lips', title: 'Lips', hint: 'shapes of speech: closed, rounded, pressed, tongue', of: /^(tongue|mouth(?!Smile|Frown|Dimple|Stretch))/},
  {key: 'corners', title: 'Smile and frown', hint: 'corners of the mouth', of: /^mouth(Smile|Frown|Dimple|Stretch)/},
  {key: 'cheeks_nose', title: 'Cheeks and nose', hint: 'puffed, raised, wrinkled', of: /^(cheek|nose)/},
];
