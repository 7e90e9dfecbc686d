// The user's avatar on the page, with all decoders.
import {makeDecoders} from './decoders.js';
import {openModel as open} from './model_avatar.js';

export const openModel = (file, canvas) => open(file, canvas, makeDecoders);
