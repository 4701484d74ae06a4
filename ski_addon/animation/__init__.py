"""From a recording to keyframes: world poses of every body per scene frame, then local channels per bone. No bpy."""
