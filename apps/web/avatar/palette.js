// Colours of the avatar, in the non-linear units that the shader multiplies by light.

export const rgb = hex => [1, 3, 5].map(at => parseInt(hex.slice(at, at + 2), 16) / 255);

export const palette = {
  skin: rgb('#f0bd9b'), lid: rgb('#e9ae8c'), lidEdge: rgb('#c4766a'), blush: rgb('#e8836f'), freckle: rgb('#c98a66'), ear: rgb('#e59c80'),
  lip: rgb('#c9655f'), lipDeep: rgb('#9c3f41'), mouth: rgb('#47151a'), throat: rgb('#1c0709'),
  tongue: rgb('#dc6f73'), tooth: rgb('#fbf6ee'), gum: rgb('#c4625f'),
  hair: rgb('#5a3527'), hairTip: rgb('#7c4a31'), lash: rgb('#2a1712'), brow: rgb('#4a2a1f'),
  shirt: rgb('#2f8f8b'), shirtDark: rgb('#256f70'),
};
