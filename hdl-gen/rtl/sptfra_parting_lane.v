// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// What forces cause in one column of the grid: the sum over taxels of C31 f_x + C32 f_y + C33 f_z.
//
// The matrices depend on the distance of two taxels alone, along each axis: C31 is odd along x, C32 along y. So the
// ROM has a word for each distance, C33 in the highest bits, C31 in the lowest. From a force to its sum: 8 cycles.

`default_nettype none

module sptfra_parting_lane #(
    // This column
    parameter COLUMN = 0,
    // Bits of a taxel's column, and of its row
    parameter COLUMN_WIDTH = 4,
    parameter ROW_WIDTH = 4,
    // Coefficients by distance along y and x
    parameter ROM_DIR = "",
    parameter FILE = ""
) (
    input  wire clock,
    input  wire reset,
    // A force and where it acts
    input  wire valid,
    input  wire first, // of a sum
    input  wire [COLUMN_WIDTH-1:0] from_column,
    input  wire [ROW_WIDTH-1:0] rows_away,
    input  wire from_below, // of a row with a higher number
    input  wire [80:0] forces_3, // f_z, f_y, f_x, 3 cycles later
    output reg  signed [47:0] sum
);

    localparam [31:0] HERE_32 = COLUMN;
    localparam [COLUMN_WIDTH-1:0] HERE = HERE_32[COLUMN_WIDTH-1:0];

    // ---- Stage 1: the distance; stage 2: its coefficients
    reg [3:1] valids;
    reg [3:1] firsts;
    reg [ROW_WIDTH+COLUMN_WIDTH-1:0] address_1;
    reg from_right_1, from_below_1, from_right_2, from_below_2;
    wire [COLUMN_WIDTH:0] apart = {1'b0, from_column} - {1'b0, HERE};
    wire from_right = !apart[COLUMN_WIDTH]; // or from here, where C31 is 0
    wire [53:0] coefficients_2;

    always @(posedge clock) begin
        valids <= {valids[2:1], valid};
        firsts <= {firsts[2:1], first};
        address_1 <= {rows_away, from_right ? apart[COLUMN_WIDTH-1:0] : HERE - from_column};
        {from_right_2, from_right_1} <= {from_right_1, from_right};
        {from_below_2, from_below_1} <= {from_below_1, from_below};
        if (reset) begin
            valids <= 3'd0;
        end
    end

    sptfra_rom #(
        .WIDTH         (54),
        .DEPTH         (1 << (ROW_WIDTH + COLUMN_WIDTH)),
        .ADDRESS_WIDTH (ROW_WIDTH + COLUMN_WIDTH),
        .ROM_DIR       (ROM_DIR),
        .FILE          (FILE)
    ) coefficients (
        .clock   (clock),
        .enable  (1'b1),
        .address (address_1),
        .data    (coefficients_2)
    );

    // ---- Stage 3: their signs
    reg signed [17:0] c31_3, c32_3, c33_3;

    always @(posedge clock) begin
        c31_3 <= from_right_2 ? -$signed(coefficients_2[17:0]) : $signed(coefficients_2[17:0]);
        c32_3 <= from_below_2 ? -$signed(coefficients_2[35:18]) : $signed(coefficients_2[35:18]);
        c33_3 <= $signed(coefficients_2[53:36]);
    end

    // ---- Stages 4 to 6: the products; 7 and 8: their sum
    wire signed [47:0] sum_x, sum_y, sum_z;
    reg signed [47:0] sum_xy_7;
    reg signed [47:0] sum_z_7;

    sptfra_mac mac_x (
        .clock       (clock),
        .reset       (reset),
        .valid       (valids[3]),
        .first       (firsts[3]),
        .coefficient (c31_3),
        .data        ($signed(forces_3[26:0])),
        .accumulator (sum_x)
    );

    sptfra_mac mac_y (
        .clock       (clock),
        .reset       (reset),
        .valid       (valids[3]),
        .first       (firsts[3]),
        .coefficient (c32_3),
        .data        ($signed(forces_3[53:27])),
        .accumulator (sum_y)
    );

    sptfra_mac mac_z (
        .clock       (clock),
        .reset       (reset),
        .valid       (valids[3]),
        .first       (firsts[3]),
        .coefficient (c33_3),
        .data        ($signed(forces_3[80:54])),
        .accumulator (sum_z)
    );

    always @(posedge clock) begin
        sum_xy_7 <= sum_x + sum_y;
        sum_z_7 <= sum_z;
        sum <= sum_xy_7 + sum_z_7;
    end

endmodule

`default_nettype wire
