"""The look of the skier: clothes, helmet, boots, skis and poles as plain arrays, sized from a `Skeleton`. No bpy."""
