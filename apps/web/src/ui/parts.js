// Parts of the tracker in the words of users: which stages each has.
export const trackerParts = {detection: ['proposal'], face: ['warp', 'encoder', 'heads', 'decoders'], audio: ['sound']};
