"""The three tabs of the right panel: Light, Material, View."""
