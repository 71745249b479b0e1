// What LCM must not see: it keeps every channel name it ever met, and a crafted header of a
// fragmented message ("LC03", as none of ours is) makes it write outside its memory.
#pragma once

namespace ergocast {

/// From now on the kernel passes on to this socket of LCM's only unfragmented LCM messages under
/// our channels' names (with any number of up to three digits where there is one for each agent),
/// and no longer than ours.
/// Of any other datagram nothing is left but four bytes, which LCM throws away at once; the kernel
/// would count one that is dropped as lost for want of buffer space. Needs no privileges. False if
/// the kernel cannot do it: then it passes on everything.
bool admit_only_our_channels(int socket);

}  // namespace ergocast
