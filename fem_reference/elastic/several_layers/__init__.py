"""What contacts with stacks and graded layers have of their own: errors of the mesh's end, and contacts that lift off.

Enters: solved contacts. Leaves: error bars, and refusals of contacts that would pull inside.
"""
