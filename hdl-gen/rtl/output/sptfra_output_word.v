// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Output word pipeline: selects one word of a beat, from the summary or the field, and converts it to float32.
//
// Latency from the word's number to the beat: 9 enabled cycles. Names end in the cycles since the beat was issued, see
// sptfra_output.

`default_nettype none

module sptfra_output_word #(
    // A step of a force is 2^FORCE_LSB N, of a torque 2^TORQUE_LSB N m, of a taxel's force 2^FIELD_LSB N
    parameter integer FORCE_LSB = -50,
    parameter integer TORQUE_LSB = -55,
    parameter integer FIELD_LSB = -50
) (
    input  wire clock,
    input  wire advance,
    // The word
    input  wire [3:0] word_2, // of the summary
    input  wire in_field_3, // or of the field
    input  wire blank_3, // no answer: zeros
    input  wire behind_3, // behind the frame's last word: 0
    input  wire signed [63:0] field_value_3,
    output wire [31:0] data_11,
    // The frame, held
    input  wire [15:0] frame_2, // its number
    input  wire [15:0] status,
    input  wire [31:0] timestamp,
    input  wire [31:0] counters, // word 13
    input  wire [4:0] scale, // forces, torques and error are divided by two to its power
    input  wire [6*64-1:0] wrench, // forces in x, y, z, torques in x, y, z, the first in the lowest bits
    input  wire [63:0] friction_quotient,
    input  wire signed [9:0] friction_exponent,
    input  wire signed [31:0] angle, // 29 fraction bits
    input  wire [63:0] error_value, // standard error, in steps of a force times 2^error_exponent
    input  wire signed [9:0] error_exponent,
    input  wire signed [17:0] mu_x, // 16 fraction bits
    input  wire signed [17:0] mu_y
);

    localparam signed [9:0] FORCE_EXPONENT = FORCE_LSB[9:0];
    localparam signed [9:0] TORQUE_EXPONENT = TORQUE_LSB[9:0];
    localparam signed [9:0] FIELD_EXPONENT = FIELD_LSB[9:0];
    localparam signed [9:0] FRICTION_EXPONENT = -10'sd16;
    localparam signed [9:0] ANGLE_EXPONENT = -10'sd29;

    // ---- Stages 3 and 4: the summary's words, and the field's in stage 4
    wire signed [9:0] scale_exponent = $signed({5'd0, scale});
    reg [3:0] word_3;
    reg signed [63:0] summary_3;
    reg signed [9:0] summary_exponent_3;
    reg signed [9:0] field_exponent_3; // the next frame may be held while a last word is here
    reg signed [63:0] value_4;
    reg signed [9:0] exponent_4;
    reg [11:4] raws; // words that are no float32
    wire raw_3 = !in_field_3 && ((word_3 == 4'd0) || (word_3 == 4'd1) || (word_3 == 4'd13));

    always @(posedge clock) begin
        if (advance) begin
            raws <= {raws[10:4], raw_3};
            // Stage 3
            word_3 <= word_2;
            field_exponent_3 <= FIELD_EXPONENT - scale_exponent;
            summary_exponent_3 <= FORCE_EXPONENT - scale_exponent;
            case (word_2)
                4'd0: summary_3 <= {32'd0, frame_2, status};
                4'd1: summary_3 <= {32'd0, timestamp};
                4'd2: summary_3 <= wrench[64*0 +: 64];
                4'd3: summary_3 <= wrench[64*1 +: 64];
                4'd4: summary_3 <= wrench[64*2 +: 64];
                4'd5: begin
                    summary_3 <= wrench[64*3 +: 64];
                    summary_exponent_3 <= TORQUE_EXPONENT - scale_exponent;
                end
                4'd6: begin
                    summary_3 <= wrench[64*4 +: 64];
                    summary_exponent_3 <= TORQUE_EXPONENT - scale_exponent;
                end
                4'd7: begin
                    summary_3 <= wrench[64*5 +: 64];
                    summary_exponent_3 <= TORQUE_EXPONENT - scale_exponent;
                end
                4'd8: begin
                    summary_3 <= friction_quotient;
                    summary_exponent_3 <= friction_exponent;
                end
                4'd9: begin
                    summary_3 <= { {32{angle[31]}}, angle};
                    summary_exponent_3 <= ANGLE_EXPONENT;
                end
                4'd10: begin
                    summary_3 <= { {46{mu_x[17]}}, mu_x};
                    summary_exponent_3 <= FRICTION_EXPONENT;
                end
                4'd11: begin
                    summary_3 <= { {46{mu_y[17]}}, mu_y};
                    summary_exponent_3 <= FRICTION_EXPONENT;
                end
                4'd12: begin
                    summary_3 <= error_value;
                    summary_exponent_3 <= error_exponent + FORCE_EXPONENT - scale_exponent;
                end
                4'd13: summary_3 <= {32'd0, counters};
                default: summary_3 <= 64'sd0;
            endcase
            // Stage 4
            if (in_field_3) begin
                value_4 <= (blank_3 || behind_3) ? 64'sd0 : field_value_3;
                exponent_4 <= field_exponent_3;
            end else begin
                value_4 <= (blank_3 && !raw_3) ? 64'sd0 : summary_3;
                exponent_4 <= summary_exponent_3;
            end
        end
    end

    // ---- Stages 5 to 11: float32; words that are none pass beside it
    wire [31:0] float_word;
    reg [7*32-1:0] raw_words; // of stages 11 to 5

    sptfra_fixed_to_float fixed_to_float (
        .clock      (clock),
        .enable     (advance),
        .fixed      (value_4),
        .exponent   (exponent_4),
        .float_bits (float_word)
    );

    always @(posedge clock) begin
        if (advance) begin
            raw_words <= {raw_words[6*32-1:0], value_4[31:0]};
        end
    end

    assign data_11 = raws[11] ? raw_words[7*32-1 -: 32] : float_word;

endmodule

`default_nettype wire
